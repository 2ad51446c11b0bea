#pragma once

#include <Eigen/Core>

#include "autodiff.h"

namespace drake_haptics {

/// Forces of contacts that press into a common elastic skin, over its
/// stiffness: `compression` (m), and its derivative by the depths.
template <typename T>
struct SkinForcesOf {
  VectorOf<T> compression;
  MatrixOf<T> coupling;  ///< symmetric, positive semidefinite
};
using SkinForces = SkinForcesOf<double>;

/// Finds λ >= 0 with C λ >= w, and C λ = w where λ > 0: the one minimum of
/// ½ λᵀ C λ − wᵀ λ. By block principal pivoting: contacts that would pull are
/// left out, those left out that would be overlapped are taken back.
/// @param C compliance, symmetric and positive definite.
/// @param w depths, m, above 0.
SkinForces SolveSkin(const Eigen::MatrixXd& C, const Eigen::VectorXd& w);

/// The same with derivatives. Which contacts push stays: with H the coupling,
/// λ changes by H (dw − dC λ) and H by −H dC H.
SkinForcesOf<AutoDiff> SolveSkin(const MatrixOf<AutoDiff>& C,
                                 const VectorOf<AutoDiff>& w);

}  // namespace drake_haptics
