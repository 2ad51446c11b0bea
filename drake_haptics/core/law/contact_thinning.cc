#include "law/contact_thinning.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "base/autodiff.h"
#include "base/require.h"

namespace drake_haptics {
namespace {

constexpr double kCosine = std::numbers::sqrt2 / 2;

template <typename T>
bool StandsFor(const ContactOf<T>& deep, const ContactOf<T>& other,
               double cell) {
  return deep.object == other.object &&
         deep.nhat_BA_W.dot(other.nhat_BA_W) > kCosine &&
         (deep.p_WC - other.p_WC).squaredNorm() < cell * cell;
}

}  // namespace

template <typename T>
void ThinContacts(const std::vector<ContactOf<T>>& contacts, double cell,
                  std::vector<ContactOf<T>>* out) {
  RequireNotNegative(cell, "cell");
  std::vector<std::size_t> order(contacts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) {
                     return contacts[i].distance < contacts[j].distance;
                   });
  // Deepest first; then those that stay return to the given order.
  std::vector<std::size_t> kept;
  std::vector<T> extent;
  for (const std::size_t i : order) {
    const auto deeper =
        std::find_if(kept.begin(), kept.end(), [&](std::size_t j) {
          return StandsFor(contacts[j], contacts[i], cell);
        });
    if (deeper == kept.end()) {
      kept.push_back(i);
      extent.push_back(contacts[i].extent);
    } else {
      extent[deeper - kept.begin()] += contacts[i].extent;
    }
  }
  std::vector<std::size_t> place(kept.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::sort(place.begin(), place.end(),
            [&](std::size_t a, std::size_t b) { return kept[a] < kept[b]; });
  out->clear();
  for (const std::size_t k : place) {
    out->push_back(contacts[kept[k]]);
    out->back().extent = extent[k];
  }
}

template void ThinContacts(const std::vector<Contact>&, double,
                           std::vector<Contact>*);
template void ThinContacts(const std::vector<ContactOf<AutoDiff>>&, double,
                           std::vector<ContactOf<AutoDiff>>*);

}  // namespace drake_haptics
