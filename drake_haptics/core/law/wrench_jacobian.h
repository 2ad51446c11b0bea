#pragma once

#include <vector>

#include "law/clustering.h"
#include "law/penalty_force.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Derivatives of the contact wrench [torque (N·m); force (N)] on the tool at
/// To in the world. Displacements are [rotation vector (rad); translation (m)]
/// of a body about its origin, velocities [angular (rad/s); linear (m/s)].
struct WrenchJacobian {
  Mat6 by_X_WT = Mat6::Zero();
  Mat6 by_V_WT = Mat6::Zero();
  std::vector<Mat6> by_X_WO;  ///< of each object
  std::vector<Mat6> by_V_WO;
};

/// A body with its pieces that moves.
struct MovingShape {
  const Decomposition* shape = nullptr;
  Pose X_WB;
  Vec6 V_WB = Vec6::Zero();
};

/// The derivative of ComputePenaltyWrench of the clusters of contacts while
/// features, and which contacts are together or push, stay as they are. Unlike
/// the K of a WrenchModel it has all that turns and slides, so that it is
/// neither symmetric nor definite. Where an edge or a face is flush to
/// round-off there is none, and this is a mean of those to both sides.
/// @param contacts as the query gave them at these poses, not shaded.
/// @param clusters of ClusterContacts or ShareStiffness with `tolerance`.
/// @throws std::invalid_argument, std::out_of_range where contacts, clusters
///         and bodies do not belong together.
WrenchJacobian ComputeWrenchJacobian(
    const std::vector<Contact>& contacts, const ClusterSet& clusters,
    double tolerance, const MovingShape& tool,
    const std::vector<MovingShape>& objects,
    const std::vector<ContactMaterial>& materials);

}  // namespace drake_haptics
