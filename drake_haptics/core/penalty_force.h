#pragma once

#include <vector>

#include "clustering.h"
#include "types.h"
#include "wrench_model.h"

namespace drake_haptics {

/// Stiffness and damping of the contacts (paper, Eq. 6).
struct PenaltyGains {
  double stiffness = 0;  ///< k, N/m
  double damping = 0;    ///< k_v, N·s/m
  double tolerance = 0;  ///< t, m
};

/// A moving frame in the world: origin (m) and spatial velocity
/// [angular (rad/s); linear (m/s)].
struct MovingFrame {
  Vec3 p_WF = Vec3::Zero();
  Vec6 V_WF = Vec6::Zero();
};

/// The wrenches of all clusters.
struct PenaltyWrench {
  WrenchModel tool;               ///< on the tool at To
  std::vector<Vec6> F_objects_W;  ///< on each object at its origin (Eq. 7, 10)
  std::vector<Vec3> f_cluster_W;  ///< force on the tool of each cluster, N
};

/// Sums the penalty wrenches of the clusters (paper, Eq. 6 to 10): at each an
/// elastic force k (t − d) along n, and k_v |v| more while the surfaces
/// approach. The force never pulls. Normals and positions are frozen in the
/// stiffness K = Σ k G Gᵀ with G = [r × n; n]: the terms that turn with the
/// normal are left out, which keeps K positive semidefinite.
/// @param objects one frame for each object that the clusters name.
/// @throws std::invalid_argument for gains below zero or not finite,
///         std::out_of_range for a cluster on an object that is not given.
PenaltyWrench ComputePenaltyWrench(const std::vector<Cluster>& clusters,
                                   const MovingFrame& tool,
                                   const std::vector<MovingFrame>& objects,
                                   const PenaltyGains& gains);

}  // namespace drake_haptics
