#pragma once

#include <vector>

#include "base/types.h"
#include "law/clustering.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// Gains of contacts with an object (paper, Eq. 6).
struct ContactMaterial {
  double stiffness = 0;  ///< k, N/m
  double damping = 0;    ///< k_v, N·s/m
};

/// @throws std::invalid_argument for a gain below zero or not finite.
void RequireMaterial(const ContactMaterial& material);

/// A moving frame in the world: origin (m) and spatial velocity
/// [angular (rad/s); linear (m/s)].
template <typename T>
struct MovingFrameOf {
  Vec3Of<T> p_WF = Vec3Of<T>::Zero();
  Vec6Of<T> V_WF = Vec6Of<T>::Zero();

  /// A unit force along n at a point C, as a wrench [r × n; n] on the frame.
  Vec6Of<T> Lever(const Vec3Of<T>& p_WC, const Vec3Of<T>& n) const {
    Vec6Of<T> wrench;
    wrench << (p_WC - p_WF).cross(n), n;
    return wrench;
  }
};
using MovingFrame = MovingFrameOf<double>;

/// Wrenches of all clusters. Objects without contact have no entry, since a
/// scene can have many.
template <typename T>
struct PenaltyWrenchOf {
  WrenchModelOf<T> tool;               ///< on the tool at To
  std::vector<Vec3Of<T>> f_cluster_W;  ///< force on the tool of each cluster, N
  /// Wrench of each cluster on its object, at the object's origin (Eq. 7, 10).
  std::vector<Vec6Of<T>> F_cluster_W;
  std::vector<int> object;  ///< of each cluster
  int num_objects = 0;      ///< touched or not

  /// The wrench on each object at its origin.
  std::vector<Vec6Of<T>> SumByObject() const;

  /// The norm of each cluster's force, N.
  std::vector<T> NormalForces() const;
};
using PenaltyWrench = PenaltyWrenchOf<double>;

/// Sums the penalty wrenches of the clusters (paper, Eq. 6 to 10): each has an
/// elastic force along n, k times its compression, plus k_v |v| times its
/// damping share while the surfaces approach. The force never pulls. At rest,
/// the edge of approach, the derivative by the velocity is the mean of both
/// sides. Normals, positions and shares are frozen in the stiffness
/// K = Σ k H_ij G_i G_jᵀ with G = [r × n; n] and H the set's coupling: the
/// terms from turning normals are left out, which keeps K positive
/// semidefinite.
/// @param objects one frame for each object that the clusters name.
/// @param materials one for each object.
/// @throws std::invalid_argument for a gain below zero or not finite of an
///         object that is touched, or where there are not as many materials as
///         objects; std::out_of_range for a cluster on an object that is not
///         given.
template <typename T>
PenaltyWrenchOf<T> ComputePenaltyWrench(
    const ClusterSetOf<T>& clusters, const MovingFrameOf<T>& tool,
    const std::vector<MovingFrameOf<T>>& objects,
    const std::vector<ContactMaterial>& materials);

}  // namespace drake_haptics
