#include "shared_stiffness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <type_traits>

#include "contact_patch.h"
#include "contact_shares.h"
#include "require.h"
#include "skin_forces.h"

namespace drake_haptics {
namespace {

// ρ, the share of the compliance that is a contact's own.
constexpr double kOwnShare = 0.25;
// Square of what rounding leaves between equal normals: far below what a force
// can show.
constexpr double kSameNormal = 1e-26;

template <typename T>
using Normals = std::vector<Vec3Of<T>>;

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

// The direction of a contact among those of the contacts before it. With
// derivatives each contact has its own: equal normals may turn differently.
template <typename T>
std::int32_t FindDirection(const Vec3Of<T>& nhat_BA_W, Normals<T>* normals) {
  const auto count = static_cast<std::int32_t>(normals->size());
  if constexpr (std::is_same_v<T, double>) {
    for (std::int32_t a = count - 1; a >= 0; --a) {
      if (((*normals)[a] - nhat_BA_W).squaredNorm() < kSameNormal) return a;
    }
  }
  normals->push_back(nhat_BA_W);
  return count;
}

template <typename T>
SkinOf<T> MakeSkin(std::span<const ContactOf<T>* const> contacts,
                   double tolerance) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  SkinOf<T> skin{VectorOf<T>(n), ContactShares<T>(contacts, tolerance), {}, {}};
  Normals<T> normals;
  normals.reserve(n);
  skin.direction.reserve(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    skin.depth[i] = tolerance - contacts[i]->distance;
    skin.slope[i] /= kOwnShare;
    skin.direction.push_back(FindDirection(contacts[i]->nhat_BA_W, &normals));
  }
  const auto d = static_cast<Eigen::Index>(normals.size());
  skin.common.resize(d, d);
  for (Eigen::Index a = 0; a < d; ++a) {
    skin.common(a, a) = 1 - kOwnShare;
    for (Eigen::Index b = 0; b < a; ++b) {
      skin.common(a, b) = skin.common(b, a) =
          (1 - kOwnShare) * InCommon<T>(normals[a], normals[b]);
    }
  }
  return skin;
}

// Appends the coupling of one object's contacts.
template <typename T>
void Append(const SkinOf<T>& skin, const SkinForcesOf<T>& forces,
            SkinCouplingOf<T>* out) {
  const auto first = static_cast<std::int32_t>(out->directions.size());
  const auto count = static_cast<std::int32_t>(skin.common.rows());
  out->together.reserve(out->together.size() + forces.together.size());
  for (std::size_t i = 0; i < skin.direction.size(); ++i) {
    out->members.push_back({forces.slope[i], first + skin.direction[i]});
  }
  for (std::int32_t a = 0; a < count; ++a) {
    out->directions.push_back(
        {forces.direction_slope[a], first, count, out->together.size()});
    for (std::int32_t b = 0; b < count; ++b) {
      out->together.push_back(forces.together(b, a));
    }
  }
}

// Damping sets in over the thickness of the pressure layer.
template <typename T>
T DampingDepth(const T& depth, double tolerance) {
  return std::max<T>(depth, PressureLayer(tolerance));
}

// A contact alone bears all of its depth, with the compliance of one.
template <typename T>
void PressAlone(double tolerance, ClusterOf<T>* cluster,
                SkinCouplingOf<T>* coupling) {
  cluster->compression = tolerance - cluster->distance;
  cluster->damping_share =
      cluster->compression / DampingDepth(cluster->compression, tolerance);
  const auto direction = static_cast<std::int32_t>(coupling->directions.size());
  coupling->members.push_back({T(1 / kOwnShare), direction});
  coupling->directions.push_back(
      {T(1 / kOwnShare), direction, 1, coupling->together.size()});
  coupling->together.push_back(T(1));
}

// Presses with the clusters from `first` on, which are those of one object.
template <typename T>
void Press(std::span<const ContactOf<T>* const> contacts, double tolerance,
           std::size_t first, ClusterSetOf<T>* out) {
  if (contacts.size() == 1) {
    PressAlone(tolerance, &out->clusters[first], &out->coupling);
    return;
  }
  const SkinOf<T> skin = MakeSkin(contacts, tolerance);
  const SkinForcesOf<T> forces = SolveSkin(skin);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ClusterOf<T>& cluster = out->clusters[first + i];
    cluster.compression = forces.compression[i];
    cluster.damping_share =
        cluster.compression / DampingDepth(skin.depth[i], tolerance);
  }
  Append(skin, forces, &out->coupling);
}

}  // namespace

template <typename T>
void ShareStiffness(const std::vector<ContactOf<T>>& contacts, double tolerance,
                    ClusterSetOf<T>* out) {
  RequireNotNegative(tolerance, "tolerance");
  out->clusters.clear();
  out->coupling.clear();
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
  out->coupling.directions.reserve(pushing.size());
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
