#include "shared_stiffness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "contact_patch.h"
#include "skin_forces.h"

namespace drake_haptics {
namespace {

// ρ, the share of the compliance that is a contact's own.
constexpr double kOwnShare = 0.25;
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
  const T turn = std::max<T>(0.0, T(1 - a.nhat_BA_W.dot(b.nhat_BA_W)));
  if (turn >= kSameDirection) return T(0);
  const T deeper = tolerance - std::min(a.distance, b.distance);
  const T same_depth =
      Fade<T>(abs(a.distance - b.distance), kSameDepth * deeper);
  if (same_depth == 0.0) return T(0);
  const T in_one_plane = Fade<T>(turn, kSamePlane) * a.flushness * b.flushness;
  const T in_one_place =
      Fade<T>(turn, kSameDirection) *
      Fade<T>((a.p_WC - b.p_WC).norm(),
              tolerance + Reach(a, tolerance) + Reach(b, tolerance));
  return std::min<T>(
      1.0, T(kAlmost * same_depth * std::max(in_one_plane, in_one_place)));
}

// m of a contact with the given sameness to all contacts: its share of the
// extent of those that are more than θ the same, averaged over θ from 0 to 1.
// Where each is wholly the same or not at all that is its share of the whole;
// in between it changes with the sameness by no more than one to one, however
// different the extents.
template <typename T>
T Share(Eigen::Index i, const VectorOf<T>& extent, const VectorOf<T>& sameness,
        std::vector<Eigen::Index>* order) {
  order->clear();
  for (Eigen::Index j = 0; j < extent.size(); ++j) {
    if (j != i && sameness[j] > 0.0) order->push_back(j);
  }
  std::sort(order->begin(), order->end(), [&](Eigen::Index a, Eigen::Index b) {
    return sameness[a] > sameness[b];
  });
  T share{0}, total = extent[i], above{1};
  for (const Eigen::Index j : *order) {
    share += (above - sameness[j]) * extent[i] / total;
    above = sameness[j];
    total += extent[j];
  }
  return share + above * extent[i] / total;
}

template <typename T>
VectorOf<T> Shares(std::span<const ContactOf<T>* const> contacts,
                   double tolerance) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  VectorOf<T> extent(n);
  MatrixOf<T> sameness(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    extent[i] = contacts[i]->extent + kLeastExtent;
    for (Eigen::Index j = 0; j < i; ++j) {
      sameness(i, j) = sameness(j, i) =
          Sameness(*contacts[i], *contacts[j], tolerance);
    }
  }
  VectorOf<T> shares(n);
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < n; ++i) {
    shares[i] = Share<T>(i, extent, sameness.col(i), &order);
  }
  return shares;
}

// What contacts under an angle have in common: 1 along one direction, nothing
// from a right angle on. A Wendland function, which is positive definite on the
// sphere (Gneiting 2013), so that C is, for any number of contacts.
template <typename T>
T InCommon(const Vec3Of<T>& n, const Vec3Of<T>& other) {
  using std::atan2, std::sqrt;
  const T cosine = n.dot(other);
  if (cosine <= 0.0) return T(0);
  const T sine_squared = n.cross(other).squaredNorm();
  // Flat there, but the angle has no slope.
  if (sine_squared == 0.0) return T(1);
  const T angle = atan2(T(sqrt(sine_squared)), cosine) / std::numbers::pi * 2;
  const T rest = 1 - angle;
  return (1 + 4 * angle) * rest * rest * rest * rest;
}

}  // namespace

template <typename T>
MatrixOf<T> SkinCompliance(std::span<const ContactOf<T>* const> contacts,
                           double tolerance) {
  const VectorOf<T> shares = Shares<T>(contacts, tolerance);
  const auto n = static_cast<Eigen::Index>(contacts.size());
  MatrixOf<T> C(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    C(i, i) = (1 - kOwnShare) + kOwnShare / shares[i];
    for (Eigen::Index j = i + 1; j < n; ++j) {
      C(i, j) = C(j, i) = (1 - kOwnShare) * InCommon<T>(contacts[i]->nhat_BA_W,
                                                        contacts[j]->nhat_BA_W);
    }
  }
  return C;
}

namespace {

// Forces of the clusters from `first` on, which are those of one object.
template <typename T>
void Press(std::span<const ContactOf<T>* const> contacts, double tolerance,
           std::size_t first, ClusterSetOf<T>* out) {
  const std::size_t all = out->clusters.size();
  VectorOf<T> depth(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    depth[i] = tolerance - contacts[i]->distance;
  }
  const SkinForcesOf<T> forces =
      SolveSkin(SkinCompliance<T>(contacts, tolerance), depth);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ClusterOf<T>& cluster = out->clusters[first + i];
    cluster.compression = forces.compression[i];
    // Damping sets in over the thickness of the pressure layer.
    cluster.damping_share =
        cluster.compression / std::max<T>(depth[i], PressureLayer(tolerance));
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      out->coupling[(first + i) * all + first + j] = forces.coupling(i, j);
    }
  }
}

}  // namespace

template <typename T>
void ShareStiffness(const std::vector<ContactOf<T>>& contacts, double tolerance,
                    ClusterSetOf<T>* out) {
  RequireTolerance(tolerance);
  out->clusters.clear();
  out->label.assign(contacts.size(), -1);
  std::vector<const ContactOf<T>*> pushing;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactOf<T>& contact = contacts[i];
    if (!(contact.distance < tolerance)) continue;
    out->label[i] = static_cast<std::int32_t>(out->clusters.size());
    out->clusters.push_back({contact.distance, contact.nhat_BA_W, contact.p_WC,
                             T(0), T(0), contact.object, 1});
    pushing.push_back(&contact);
  }
  out->coupling.assign(pushing.size() * pushing.size(), T(0));
  for (std::size_t first = 0, end; first < pushing.size(); first = end) {
    end = first;
    while (end < pushing.size() &&
           pushing[end]->object == pushing[first]->object) {
      ++end;
    }
    Press<T>({pushing.data() + first, end - first}, tolerance, first, out);
  }
}

template Eigen::MatrixXd SkinCompliance(std::span<const Contact* const>,
                                        double);
template void ShareStiffness(const std::vector<Contact>&, double, ClusterSet*);
template void ShareStiffness(const std::vector<ContactOf<AutoDiff>>&, double,
                             ClusterSetOf<AutoDiff>*);

}  // namespace drake_haptics
