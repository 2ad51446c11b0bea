#include "contact_shares.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "contact_patch.h"

namespace drake_haptics {
namespace {

// 1 − cos(3°): contacts of flush features within that angle can be one
// constraint, wherever they are.
constexpr double kSamePlane = 1.37e-3;
// 1 − cos(45°): the same for contacts in one place, as on the facets of a
// surface that is smooth.
constexpr double kSameDirection = 0.293;
// Contacts at depths below the tolerance that differ by less than this share
// can be one constraint. A share, not a length: how fast contacts part must not
// depend on how deep they are.
constexpr double kSameDepth = 0.25;
// Contacts that are nearly the same count as wholly so: what little is missing
// would leave each a spring of its own.
constexpr double kAlmost = 1.25;
// Added to extents (m²), so that those of no extent are shared equally.
constexpr double kLeastExtent = 1e-24;

template <typename T>
T Fade(const T& distance, const T& width) {
  if (distance == 0.0) return T(1);
  return width > 0.0 ? std::max<T>(0.0, T(1 - distance / width)) : T(0);
}

// How far a flush face or edge reaches, m: as far as an edge of its extent.
template <typename T>
T Reach(const ContactOf<T>& contact, double tolerance) {
  return contact.flushness * contact.extent / PressureLayer(tolerance);
}

// In how far two contacts are parts of one constraint, 0 to 1.
template <typename T>
T Sameness(const ContactOf<T>& a, const ContactOf<T>& b, double tolerance) {
  using std::abs;
  const T deeper = tolerance - std::min(a.distance, b.distance);
  const T same_depth =
      Fade<T>(abs(a.distance - b.distance), kSameDepth * deeper);
  if (same_depth == 0.0) return T(0);
  const T turn = std::max<T>(0.0, T(1 - a.nhat_BA_W.dot(b.nhat_BA_W)));
  if (turn >= kSameDirection) return T(0);
  const T in_one_plane = Fade<T>(turn, kSamePlane) * a.flushness * b.flushness;
  if (kAlmost * same_depth * in_one_plane >= 1.0) return T(1);
  const T in_one_place =
      Fade<T>(turn, kSameDirection) *
      Fade<T>((a.p_WC - b.p_WC).norm(),
              tolerance + Reach(a, tolerance) + Reach(b, tolerance));
  return std::min<T>(
      1.0, T(kAlmost * same_depth * std::max(in_one_plane, in_one_place)));
}

// Another contact that is in part the same as contact `of`.
template <typename T>
struct Kin {
  std::size_t of;
  T sameness;
  T extent;
};

// A contact along the axis in which all are farthest apart.
struct Placed {
  double at;     // m
  double reach;  // m
  std::size_t contact;
};

template <typename T>
class Kinship {
 public:
  Kinship(std::span<const ContactOf<T>* const> contacts, double tolerance)
      : contacts_(contacts), tolerance_(tolerance), total_(contacts.size()) {
    for (std::size_t i = 0; i < contacts.size(); ++i) total_[i] = Extent(i);
    Compare();
    std::sort(kin_.begin(), kin_.end(), [](const auto& a, const auto& b) {
      return a.of != b.of ? a.of < b.of : a.sameness > b.sameness;
    });
  }

  // A contact's share of the extent of those that are more than θ the same,
  // averaged over θ from 0 to 1. Where each is wholly the same or not at all
  // that is its share of the whole; in between it changes with the sameness by
  // no more than one to one, however different the extents.
  VectorOf<T> Shares() const {
    VectorOf<T> shares(total_.size());
    auto next = kin_.begin();
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      const T extent = Extent(i);
      T share{0}, total = total_[i], above{1};
      for (; next != kin_.end() && next->of == static_cast<std::size_t>(i);
           ++next) {
        share += (above - next->sameness) * extent / total;
        above = next->sameness;
        total += next->extent;
      }
      shares[i] = share + above * extent / total;
    }
    return shares;
  }

 private:
  T Extent(std::size_t i) const { return contacts_[i]->extent + kLeastExtent; }

  // Looks at all pairs that are near along one axis, and at those of which both
  // are flush.
  void Compare() {
    const std::vector<Placed> placed = Place();
    double widest = 0;
    for (const Placed& one : placed) widest = std::max(widest, one.reach);
    std::vector<std::size_t> flush;
    for (std::size_t k = 0; k < placed.size(); ++k) {
      if (contacts_[placed[k].contact]->flushness > 0.0) flush.push_back(k);
    }
    auto next_flush = flush.begin();
    for (std::size_t k = 0; k < placed.size(); ++k) {
      const double end = placed[k].at + tolerance_ + placed[k].reach + widest;
      std::size_t l = k + 1;
      for (; l < placed.size() && placed[l].at <= end; ++l) {
        Compare(placed[k].contact, placed[l].contact);
      }
      if (next_flush == flush.end() || *next_flush != k) continue;
      ++next_flush;
      for (auto far = std::lower_bound(next_flush, flush.end(), l);
           far != flush.end(); ++far) {
        Compare(placed[k].contact, placed[*far].contact);
      }
    }
  }

  std::vector<Placed> Place() const {
    Eigen::Array3d low = ValuesOf(contacts_[0]->p_WC), high = low;
    for (const ContactOf<T>* contact : contacts_) {
      const Eigen::Array3d p = ValuesOf(contact->p_WC);
      low = low.min(p);
      high = high.max(p);
    }
    Eigen::Index axis;
    (high - low).maxCoeff(&axis);
    std::vector<Placed> placed(contacts_.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      placed[i] = {ValueOf(contacts_[i]->p_WC[axis]),
                   ValueOf(Reach(*contacts_[i], tolerance_)), i};
    }
    std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
      return a.at != b.at ? a.at < b.at : a.contact < b.contact;
    });
    return placed;
  }

  void Compare(std::size_t i, std::size_t j) {
    const T sameness = Sameness(*contacts_[i], *contacts_[j], tolerance_);
    if (sameness >= 1.0) {
      total_[i] += Extent(j);
      total_[j] += Extent(i);
    } else if (sameness > 0.0) {
      kin_.push_back({i, sameness, Extent(j)});
      kin_.push_back({j, sameness, Extent(i)});
    }
  }

  std::span<const ContactOf<T>* const> contacts_;
  double tolerance_;
  VectorOf<T> total_;  // extents of all that are wholly the same, m²
  std::vector<Kin<T>> kin_;
};

}  // namespace

template <typename T>
VectorOf<T> ContactShares(std::span<const ContactOf<T>* const> contacts,
                          double tolerance) {
  if (contacts.size() == 1) return VectorOf<T>::Ones(1);
  return Kinship<T>(contacts, tolerance).Shares();
}

template Eigen::VectorXd ContactShares(std::span<const Contact* const>, double);
template VectorOf<AutoDiff> ContactShares(
    std::span<const ContactOf<AutoDiff>* const>, double);

}  // namespace drake_haptics
