#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "law/compression_jacobian.h"
#include "pair/contact.h"

namespace drake_haptics {

/// A contact that carries force, in the world. It stands for one contact or
/// for a cluster of them (paper, Eq. 3 to 5).
template <typename T>
struct ClusterOf {
  T distance{0};        ///< smallest distance of the members (Eq. 5), m
  Vec3Of<T> nhat_BA_W;  ///< weighted mean direction (Eq. 3), unit
  Vec3Of<T> p_WC;       ///< weighted mean position (Eq. 4), m
  /// The elastic force is the stiffness times this, m.
  T compression{0};
  /// The damping force is the damping times the speed times this.
  T damping_share{0};
  std::int32_t object = 0;
  std::int32_t num_contacts = 0;
};
using Cluster = ClusterOf<double>;

/// Clusters ordered by their first contact.
template <typename T>
struct ClusterSetOf {
  std::vector<ClusterOf<T>> clusters;
  std::vector<std::int32_t> label;  ///< cluster of each contact; -1 for none
  /// Derivative of the compressions by the depths of all clusters; symmetric
  /// and positive semidefinite. Empty if it is the identity.
  CompressionJacobianOf<T> coupling;
  /// The search for the compressions reached the bound on its steps: they push,
  /// but their energy is not quite the least. See SolveSkin.
  bool is_bounded = false;
};
using ClusterSet = ClusterSetOf<double>;

/// Groups contacts of the same object with an octree whose leaves have the size
/// `delta`: contacts in one leaf are together, and adjacent occupied leaves (26
/// neighbors) are merged (paper, 4.2). Contacts closer than delta are always
/// together, contacts of different clusters are at least delta apart; between
/// delta and 2·√3·delta the leaves decide. The weight of a member is
/// `tolerance` − distance. The force jumps where a contact crosses a cell or
/// clusters merge: see ShareStiffness.
/// @param delta leaf size, m.
/// @param tolerance the distance t below which contacts push, m; others are in
///     no cluster.
/// @throws std::invalid_argument unless delta > 0 and tolerance >= 0, finite.
template <typename T>
void ClusterContacts(const std::vector<ContactOf<T>>& contacts, double delta,
                     double tolerance, ClusterSetOf<T>* out);

/// Computes the clusters of contacts that are grouped by `out->label`. With
/// another scalar type, groups and their deepest members are the same.
template <typename T>
void RepresentClusters(const std::vector<ContactOf<T>>& contacts,
                       double tolerance, ClusterSetOf<T>* out);

}  // namespace drake_haptics
