#pragma once

#include <Eigen/Core>

namespace drake_haptics {

/// Forces of contacts that press into a common elastic skin, over its
/// stiffness: `compression` (m), and its derivative by the depths.
struct SkinForces {
  Eigen::VectorXd compression;
  Eigen::MatrixXd coupling;  ///< symmetric, positive semidefinite
};

/// Finds λ >= 0 with C λ >= w, and C λ = w where λ > 0: the one minimum of
/// ½ λᵀ C λ − wᵀ λ. By block principal pivoting: contacts that would pull are
/// left out, those left out that would be overlapped are taken back.
/// @param C compliance, symmetric and positive definite.
/// @param w depths, m, above 0.
SkinForces SolveSkin(const Eigen::MatrixXd& C, const Eigen::VectorXd& w);

}  // namespace drake_haptics
