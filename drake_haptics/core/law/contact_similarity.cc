#include "law/contact_similarity.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "law/contact_groups.h"
#include "pair/contact_patch.h"

namespace drake_haptics {
namespace {

// 1 − cos(3°): contacts of flush features within that angle can be one
// constraint, wherever they are.
constexpr double kSamePlane = 1.37e-3;
// 1 − cos(45°): the same for contacts at one place, as on the facets of a
// smooth surface.
constexpr double kSameDirection = 0.293;
// Contacts whose depths below the tolerance differ by less than this share can
// be one constraint. A share, not a length, so that the transition does not
// depend on the depth.
constexpr double kSameDepth = 0.25;
// Contacts that are nearly the same count as fully the same: the small rest
// would give each its own spring.
constexpr double kFullSimilarity = 1.25;
static_assert(kFullSimilarity * kSurelyFlush * kSurelyFlush >= 1);
// Added to extents (m²), so that contacts without extent share equally.
constexpr double kLeastExtent = 1e-24;

template <typename T>
T Fade(const T& distance, const T& width) {
  if (distance == 0.0) return T(1);
  return width > 0.0 ? std::max<T>(0.0, T(1 - distance / width)) : T(0);
}

// Reach of a flush face or edge, m: half the length of an edge of its extent.
template <typename T>
T Reach(const ContactOf<T>& contact, double tolerance) {
  return contact.flushness * contact.extent / (2 * PressureLayer(tolerance));
}

// Degree to which two contacts are parts of one constraint, 0 to 1.
template <typename T>
T Similarity(const ContactOf<T>& a, const ContactOf<T>& b, double tolerance) {
  using std::abs;
  const T deeper = tolerance - std::min(a.distance, b.distance);
  const T same_depth =
      Fade<T>(abs(a.distance - b.distance), kSameDepth * deeper);
  if (same_depth == 0.0) return T(0);
  const T turn = std::max<T>(0.0, T(1 - a.nhat_BA_W.dot(b.nhat_BA_W)));
  if (turn >= kSameDirection) return T(0);
  const T in_one_plane = Fade<T>(turn, kSamePlane) * a.flushness * b.flushness;
  if (kFullSimilarity * same_depth * in_one_plane >= 1.0) return T(1);
  const T apart =
      (a.p_WC - b.p_WC).norm() - (Reach(a, tolerance) + Reach(b, tolerance));
  const T in_one_place = Fade<T>(turn, kSameDirection) *
                         Fade<T>(std::max<T>(0.0, apart), T(tolerance));
  return std::min<T>(1.0, T(kFullSimilarity * same_depth *
                            std::max(in_one_plane, in_one_place)));
}

// Whether all contacts within the bounds are fully the same, by their planes.
bool AreSame(const GroupBounds& bounds, double flushness) {
  // Rounding must not make different contacts count as the same.
  constexpr double kSurely = 1 + 1e-9;
  return kFullSimilarity * Fade<double>(1 - bounds.least_ratio, kSameDepth) *
             Fade<double>(bounds.most_turn, kSamePlane) * flushness >=
         kSurely;
}

// Another contact that is partly the same as contact `of`.
template <typename T>
struct SimilarContact {
  std::size_t of;
  T sameness;
  T extent;
};

// Place of a contact on the axis along which all extend farthest.
struct AlongAxis {
  double at;     // m
  double reach;  // m
  std::size_t contact;
};

template <typename T>
class ContactSimilarity {
 public:
  ContactSimilarity(std::span<const ContactOf<T>* const> contacts,
                    double tolerance)
      : contacts_(contacts), tolerance_(tolerance), total_(contacts.size()) {
    for (std::size_t i = 0; i < contacts.size(); ++i) total_[i] = Extent(i);
    Compare();
    SortSimilar();
  }

  // A contact's share of the extent of those with a sameness above θ, averaged
  // over θ from 0 to 1. If each sameness is 0 or 1, it is the share of the
  // whole; in between it changes by no more than the sameness, however
  // different the extents.
  VectorOf<T> Shares() const {
    VectorOf<T> shares(total_.size());
    auto next = similar_.begin();
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      const T extent = Extent(i);
      T share{0}, total = total_[i], above{1};
      for (; next != similar_.end() && next->of == static_cast<std::size_t>(i);
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

  // Sorts by contact, the most similar first.
  void SortSimilar() {
    std::vector<std::size_t> end(total_.size() + 1, 0);
    for (const SimilarContact<T>& similar : similar_) ++end[similar.of];
    std::exclusive_scan(end.begin(), end.end(), end.begin(), std::size_t{0});
    std::vector<SimilarContact<T>> sorted(similar_.size());
    for (const SimilarContact<T>& similar : similar_)
      sorted[end[similar.of]++] = similar;
    auto first = sorted.begin();
    for (Eigen::Index i = 0; i < total_.size(); ++i) {
      const auto last = sorted.begin() + end[i];
      std::sort(first, last, [](const auto& a, const auto& b) {
        return a.sameness > b.sameness;
      });
      first = last;
    }
    similar_ = std::move(sorted);
  }

  // Compares the pairs that are near along the axis or both flush.
  void Compare() {
    const std::vector<AlongAxis> placed = Place();
    double widest = 0;
    std::vector<GroupedContact> flush;
    for (const AlongAxis& one : placed) {
      widest = std::max(widest, one.reach);
      const ContactOf<T>& contact = *contacts_[one.contact];
      if (!(contact.flushness > 0.0)) continue;
      flush.push_back({ValuesOf(contact.nhat_BA_W),
                       tolerance_ - ValueOf(contact.distance),
                       ValueOf(contact.flushness), one.contact});
    }
    for (std::size_t k = 0; k < placed.size(); ++k) {
      if (IsFlush(placed[k])) continue;
      CompareAfter(placed, k, widest);
      if (!flush.empty()) CompareFlushBefore(placed, k, widest);
    }
    if (flush.size() > 1) CompareFlush(GroupContacts(&flush));
  }

  bool IsFlush(const AlongAxis& placed) const {
    return contacts_[placed.contact]->flushness > 0.0;
  }

  std::vector<AlongAxis> Place() const {
    Eigen::Array3d low = ValuesOf(contacts_[0]->p_WC), high = low;
    for (const ContactOf<T>* contact : contacts_) {
      const Eigen::Array3d p = ValuesOf(contact->p_WC);
      low = low.min(p);
      high = high.max(p);
    }
    Eigen::Index axis;
    (high - low).maxCoeff(&axis);
    std::vector<AlongAxis> placed(contacts_.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      placed[i] = {ValueOf(contacts_[i]->p_WC[axis]),
                   ValueOf(Reach(*contacts_[i], tolerance_)), i};
    }
    std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
      return a.at != b.at ? a.at < b.at : a.contact < b.contact;
    });
    return placed;
  }

  // Compares a contact that is not flush with those near it after it on the
  // axis.
  void CompareAfter(const std::vector<AlongAxis>& placed, std::size_t k,
                    double widest) {
    const double end = placed[k].at + tolerance_ + placed[k].reach + widest;
    for (std::size_t l = k + 1; l < placed.size() && placed[l].at <= end; ++l) {
      Compare(placed[k].contact, placed[l].contact);
    }
  }

  // The same with those before it, of which only flush ones remain.
  void CompareFlushBefore(const std::vector<AlongAxis>& placed, std::size_t k,
                          double widest) {
    const double end = placed[k].at - tolerance_ - placed[k].reach - widest;
    for (std::size_t l = k; l > 0 && placed[l - 1].at >= end; --l) {
      if (IsFlush(placed[l - 1])) {
        Compare(placed[k].contact, placed[l - 1].contact);
      }
    }
  }

  // Compares all pairs of flush contacts, whole groups at once if possible.
  void CompareFlush(const std::vector<ContactGroup>& groups) {
    for (auto one = groups.begin(); one != groups.end(); ++one) {
      for (auto other = one; other != groups.end(); ++other) {
        const GroupBounds bounds = BoundGroups(*one, *other);
        if (bounds.most_ratio <= 1 - kSameDepth ||
            bounds.least_turn >= kSameDirection) {
          continue;
        }
        if (AreSame(bounds, one->least_flushness * other->least_flushness)) {
          AddSame(*one, *other);
        } else {
          CompareAll(*one, *other);
        }
      }
    }
  }

  void AddSame(const ContactGroup& one, const ContactGroup& other) {
    const auto add = [this](const ContactGroup& to, const ContactGroup& from) {
      T extent{0};
      for (const auto& member : from.members) extent += Extent(member.contact);
      for (const auto& member : to.members) total_[member.contact] += extent;
    };
    add(one, other);
    if (&one != &other) {
      add(other, one);
      return;
    }
    for (const auto& member : one.members) {
      total_[member.contact] -= Extent(member.contact);
    }
  }

  void CompareAll(const ContactGroup& one, const ContactGroup& other) {
    const bool is_same = &one == &other;
    for (std::size_t k = 0; k < one.members.size(); ++k) {
      for (std::size_t l = is_same ? k + 1 : 0; l < other.members.size(); ++l) {
        Compare(one.members[k].contact, other.members[l].contact);
      }
    }
  }

  void Compare(std::size_t i, std::size_t j) {
    const T sameness = Similarity(*contacts_[i], *contacts_[j], tolerance_);
    if (sameness >= 1.0) {
      total_[i] += Extent(j);
      total_[j] += Extent(i);
    } else if (sameness > 0.0) {
      similar_.push_back({i, sameness, Extent(j)});
      similar_.push_back({j, sameness, Extent(i)});
    }
  }

  std::span<const ContactOf<T>* const> contacts_;
  double tolerance_;
  VectorOf<T> total_;  // extents of all that are fully the same, m²
  std::vector<SimilarContact<T>> similar_;
};

}  // namespace

template <typename T>
VectorOf<T> ContactShares(std::span<const ContactOf<T>* const> contacts,
                          double tolerance) {
  if (contacts.size() == 1) return VectorOf<T>::Ones(1);
  return ContactSimilarity<T>(contacts, tolerance).Shares();
}

template Eigen::VectorXd ContactShares(std::span<const Contact* const>, double);
template VectorOf<AutoDiff> ContactShares(
    std::span<const ContactOf<AutoDiff>* const>, double);

}  // namespace drake_haptics
