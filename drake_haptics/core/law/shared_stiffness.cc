#include "law/shared_stiffness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "base/low_rank.h"
#include "base/require.h"
#include "law/compliance_forces.h"
#include "law/contact_similarity.h"
#include "pair/contact_patch.h"

namespace drake_haptics {
namespace {

// ρ, the share of the compliance that is a contact's own.
constexpr double kOwnShare = 0.25;
// Squared difference of equal normals by rounding, far too small to affect a
// force visibly.
constexpr double kSameNormal = 1e-26;
// Equal normals are searched for among this many earlier directions: enough for
// alternating faces; a missed one costs little more (low_rank.h).
constexpr std::size_t kRecent = 8;
// Part of c that the features may leave out. It changes forces by the same
// share, far too little to notice, and their derivatives by about its root:
// those of AutoDiffXd, which leaves out nothing, must be right to 1e-6.
constexpr double kLeftOut = 1e-11;

// Common share c of two contacts: 1 along one direction, 0 from a right angle
// on. A Wendland function, which is positive definite on the sphere (Gneiting
// 2013), so that C is, too, for any number of contacts.
template <typename T>
T InCommon(const Vec3Of<T>& n, const Vec3Of<T>& other) {
  using std::asin, std::sqrt;
  const T square = (n - other).squaredNorm();
  if (square >= 2.0) return T(0);
  // The function is flat here, but the angle has no derivative.
  if (square == 0.0) return T(1);
  const T angle = asin(T(sqrt(square) / 2)) * (4 / std::numbers::pi);
  const T rest = 1 - angle;
  return (1 + 4 * angle) * rest * rest * rest * rest;
}

// Index of a contact's direction among those of earlier contacts; appends it if
// it is new.
std::int32_t FindDirection(const Vec3& nhat_BA_W, std::vector<Vec3>* normals) {
  const std::size_t count = normals->size();
  for (std::size_t a = count; a > 0 && count - a < kRecent; --a) {
    if (((*normals)[a - 1] - nhat_BA_W).squaredNorm() < kSameNormal) {
      return static_cast<std::int32_t>(a - 1);
    }
  }
  normals->push_back(nhat_BA_W);
  return static_cast<std::int32_t>(count);
}

Skin MakeSkin(std::span<const Contact* const> contacts, double tolerance) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  Skin skin{
      Eigen::VectorXd(n), ContactShares<double>(contacts, tolerance), {}, {}};
  skin.slope /= kOwnShare;
  std::vector<Vec3> normals;
  normals.reserve(n);
  skin.direction.reserve(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    skin.depth[i] = tolerance - contacts[i]->distance;
    skin.direction.push_back(FindDirection(contacts[i]->nhat_BA_W, &normals));
  }
  skin.features = FindFeatures(
      static_cast<Eigen::Index>(normals.size()), 1 - kOwnShare, kLeftOut,
      [&normals](Eigen::Index a, Eigen::Index b) {
        return (1 - kOwnShare) * InCommon<double>(normals[a], normals[b]);
      });
  return skin;
}

// With derivatives each contact has a direction of its own: equal normals may
// turn differently.
MovingCompression MakeSkin(std::span<const ContactOf<AutoDiff>* const> contacts,
                           double tolerance) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  MovingCompression skin{VectorOf<AutoDiff>(n),
                         ContactShares<AutoDiff>(contacts, tolerance),
                         MatrixOf<AutoDiff>(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    skin.depth[i] = tolerance - contacts[i]->distance;
    skin.slope[i] /= kOwnShare;
    skin.common(i, i) = 1 - kOwnShare;
    for (Eigen::Index j = 0; j < i; ++j) {
      skin.common(i, j) = skin.common(j, i) =
          (1 - kOwnShare) *
          InCommon<AutoDiff>(contacts[i]->nhat_BA_W, contacts[j]->nhat_BA_W);
    }
  }
  return skin;
}

// Returns which contacts push.
std::vector<char> FindPushing(const MovingCompression& skin, bool* is_bounded) {
  const Eigen::Index n = skin.depth.size();
  std::vector<std::int32_t> direction(n);
  std::iota(direction.begin(), direction.end(), 0);
  const ComplianceForces forces = SolveSkin(
      {ValuesOf(skin.depth), ValuesOf(skin.slope), std::move(direction),
       FindFeatures(n, 1 - kOwnShare, kLeftOut,
                    [&skin](Eigen::Index i, Eigen::Index j) {
                      return skin.common(i, j).value();
                    })});
  *is_bounded |= forces.is_bounded;
  std::vector<char> is_pushing;
  for (const double slope : forces.slope) is_pushing.push_back(slope > 0);
  return is_pushing;
}

// The compression of a single contact is its depth.
void AppendAlone(CompressionJacobian* coupling) {
  coupling->members.push_back({1.0, -1, 0});
}

void AppendAlone(MovingCompressionJacobian* coupling) {
  const auto first = static_cast<std::int32_t>(coupling->members.size());
  coupling->members.push_back({first, 1, coupling->together.size()});
  coupling->together.push_back(AutoDiff(1));
}

// Solves for the compressions of an object's contacts (m), and appends their
// derivatives by the depths.
Eigen::VectorXd Solve(std::span<const Contact* const> contacts,
                      double tolerance, ClusterSet* out) {
  Skin skin = MakeSkin(contacts, tolerance);
  ComplianceForces forces = SolveSkin(skin);
  out->is_bounded |= forces.is_bounded;
  CompressionJacobian* const coupling = &out->coupling;
  const auto place = static_cast<std::int32_t>(coupling->skins.size());
  for (Eigen::Index i = 0; i < forces.slope.size(); ++i) {
    coupling->members.push_back({forces.slope[i], place, skin.direction[i]});
  }
  coupling->skins.push_back(
      {std::move(skin.features), std::move(forces.factor)});
  return std::move(forces.compression);
}

VectorOf<AutoDiff> Solve(std::span<const ContactOf<AutoDiff>* const> contacts,
                         double tolerance, ClusterSetOf<AutoDiff>* out) {
  const MovingCompression skin = MakeSkin(contacts, tolerance);
  MovingComplianceForces forces =
      SolveSkin(skin, FindPushing(skin, &out->is_bounded));
  MovingCompressionJacobian* const coupling = &out->coupling;
  const auto first = static_cast<std::int32_t>(coupling->members.size());
  const auto count = static_cast<std::int32_t>(contacts.size());
  for (std::int32_t i = 0; i < count; ++i) {
    coupling->members.push_back({first, count, coupling->together.size()});
    for (std::int32_t j = 0; j < count; ++j) {
      coupling->together.push_back(forces.together(i, j));
    }
  }
  return std::move(forces.compression);
}

// Damping sets in over the thickness of the pressure layer.
template <typename T>
T DampingDepth(const T& depth, double tolerance) {
  return std::max<T>(depth, PressureLayer(tolerance));
}

// Sets the forces of the clusters from `first` on, which are those of one
// object.
template <typename T>
void Press(std::span<const ContactOf<T>* const> contacts, double tolerance,
           std::size_t first, ClusterSetOf<T>* out) {
  const auto press = [&](std::size_t i, const T& compression) {
    ClusterOf<T>& cluster = out->clusters[first + i];
    const T depth = tolerance - cluster.distance;
    cluster.compression = compression;
    cluster.damping_share = compression / DampingDepth(depth, tolerance);
  };
  if (contacts.size() == 1) {
    press(0, tolerance - contacts[0]->distance);
    AppendAlone(&out->coupling);
    return;
  }
  const VectorOf<T> compressions = Solve(contacts, tolerance, out);
  for (std::size_t i = 0; i < contacts.size(); ++i) press(i, compressions[i]);
}

}  // namespace

template <typename T>
void ShareStiffness(const std::vector<ContactOf<T>>& contacts, double tolerance,
                    ClusterSetOf<T>* out) {
  RequireNotNegative(tolerance, "tolerance");
  out->clusters.clear();
  out->coupling.clear();
  out->is_bounded = false;
  out->label.assign(contacts.size(), -1);
  out->clusters.reserve(contacts.size());
  std::vector<const ContactOf<T>*> pushing;
  pushing.reserve(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactOf<T>& contact = contacts[i];
    if (!(contact.distance < tolerance)) continue;
    out->label[i] = static_cast<std::int32_t>(out->clusters.size());
    out->clusters.push_back({contact.distance, contact.nhat_BA_W, contact.p_WC,
                             T(0), T(0), contact.object, 1});
    pushing.push_back(&contact);
  }
  out->coupling.members.reserve(pushing.size());
  for (std::size_t first = 0, end; first < pushing.size(); first = end) {
    end = first;
    while (end < pushing.size() &&
           pushing[end]->object == pushing[first]->object) {
      ++end;
    }
    Press<T>({pushing.data() + first, end - first}, tolerance, first, out);
  }
}

template void ShareStiffness(const std::vector<Contact>&, double, ClusterSet*);
template void ShareStiffness(const std::vector<ContactOf<AutoDiff>>&, double,
                             ClusterSetOf<AutoDiff>*);

}  // namespace drake_haptics
