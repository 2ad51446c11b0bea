#pragma once

#include <vector>

#include "base/rotation.h"
#include "base/types.h"
#include "law/clustering.h"

namespace drake_haptics {

/// Energy that the contacts store, J: ½ Σ k e (t − d), with k e the elastic
/// force of a cluster and t − d its depth below the tolerance. It is the
/// potential of forces that are homogeneous in the depths: k (t − d) of the
/// paper (Eq. 6), and those of ShareStiffness.
/// @param stiffness k of each object that the clusters name, N/m.
/// @param tolerance t, m.
/// @throws std::out_of_range for a cluster on an object without a stiffness.
double ContactEnergy(const ClusterSet& clusters,
                     const std::vector<double>& stiffness, double tolerance);

/// Potential energy of the tool's weight, J, zero with its center of mass at
/// the world's origin.
/// @param q_WT pose of the tool.
/// @param p_TTcm center of mass of the tool in its frame, m.
/// @param weight_W m g, N.
double WeightEnergy(const PoseVector& q_WT, const Vec3& p_TTcm,
                    const Vec3& weight_W);

}  // namespace drake_haptics
