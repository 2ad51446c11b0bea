#include "law/contact_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace drake_haptics {
namespace {

// Cell sizes of normals and of the logarithm of depths.
constexpr double kTurnCell = 0.02;
constexpr double kDepthCell = 0.02;

// Flush or not, depth, and normal. Cells are centered at normal components of 0
// and 1.
using Key = std::array<std::int32_t, 5>;

Key KeyOf(const GroupedContact& contact) {
  Key key{contact.flushness > 0, static_cast<std::int32_t>(std::floor(
                                     std::log(contact.depth) / kDepthCell))};
  for (int k = 0; k < 3; ++k) {
    key[2 + k] = static_cast<std::int32_t>(
        std::lround(contact.nhat_BA_W[k] / kTurnCell));
  }
  return key;
}

ContactGroup MakeGroup(std::span<const GroupedContact> members) {
  const GroupedContact& first = members.front();
  ContactGroup group{members,         first.depth,     first.depth,
                     first.flushness, first.nhat_BA_W, 0};
  double square = 0;
  for (const GroupedContact& contact : members) {
    group.shallowest = std::min(group.shallowest, contact.depth);
    group.deepest = std::max(group.deepest, contact.depth);
    group.least_flushness = std::min(group.least_flushness, contact.flushness);
    square =
        std::max(square, (contact.nhat_BA_W - group.nhat_BA_W).squaredNorm());
  }
  group.spread = std::sqrt(square);
  return group;
}

}  // namespace

std::vector<ContactGroup> GroupContacts(std::vector<GroupedContact>* contacts) {
  struct Sorted {
    Key key;
    GroupedContact contact;
  };
  std::vector<Sorted> sorted;
  sorted.reserve(contacts->size());
  for (const GroupedContact& contact : *contacts) {
    sorted.push_back({KeyOf(contact), contact});
  }
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return a.key != b.key ? a.key < b.key
                          : a.contact.contact < b.contact.contact;
  });
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    (*contacts)[k] = sorted[k].contact;
  }
  std::vector<ContactGroup> groups;
  const std::span<const GroupedContact> all(*contacts);
  for (std::size_t first = 0, end; first < sorted.size(); first = end) {
    end = first + 1;
    while (end < sorted.size() && sorted[end].key == sorted[first].key) ++end;
    groups.push_back(MakeGroup(all.subspan(first, end - first)));
  }
  return groups;
}

GroupBounds BoundGroups(const ContactGroup& one, const ContactGroup& other) {
  const auto [upper, lower] = one.shallowest < other.shallowest
                                  ? std::pair{&one, &other}
                                  : std::pair{&other, &one};
  const double apart = (one.nhat_BA_W - other.nhat_BA_W).norm();
  const double spread = one.spread + other.spread;
  const double least = std::max(0.0, apart - spread), most = apart + spread;
  return {upper->shallowest / std::max(one.deepest, other.deepest),
          std::min(1.0, upper->deepest / lower->shallowest),
          0.5 * least * least, 0.5 * most * most};
}

}  // namespace drake_haptics
