#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "base/autodiff.h"

namespace drake_haptics {

/// Contacts that press into a common elastic skin, which yields to forces λ by
///   y_i = Σ_j φ_aᵀ φ_b λ_j + λ_i / r_i,  a and b the directions of i and j.
struct Skin {
  Eigen::VectorXd depth;                ///< w, m, above 0
  Eigen::VectorXd slope;                ///< r, above 0
  std::vector<std::int32_t> direction;  ///< of each contact
  Eigen::MatrixXd features;             ///< φ, a column for each direction
};

/// Forces, over the stiffness, and the data of their CompressionJacobian.
struct ComplianceForces {
  Eigen::VectorXd compression;  ///< λ, m
  Eigen::VectorXd slope;        ///< r where λ > 0, else 0
  Eigen::MatrixXd factor;       ///< L, L Lᵀ = 1 + Σ r φ φᵀ over these
  /// The search reached the bound on its steps: the forces push, but their
  /// energy is not quite the least.
  bool is_bounded = false;
};

/// More than twice the steps that the hardest random skins have needed: 49 for
/// 1,000 contacts, 26 for 100.
inline constexpr int kMaxSkinSteps = 128;

/// Finds λ >= 0 with y >= w, and y = w where λ > 0: the only minimum of
/// ½ λᵀ y(λ) − wᵀ λ. There λ_i = r_i (w_i − φ_aᵀ u)₊, where u, the common yield
/// of the skin, minimizes
///   ½ uᵀ u + ½ Σ r_i (w_i − φ_aᵀ u)₊²
/// This is convex and piecewise quadratic, and u has as many entries as there
/// are features: Newton's method with an exact search along each step never
/// ascends and ends at the minimum (Sun 1997). The time of a step grows with
/// the contacts, and with the directions times the square of the features.
ComplianceForces SolveSkin(const Skin& skin, int max_steps = kMaxSkinSteps);

/// The same with derivatives. Each contact has its own direction here.
struct MovingCompression {
  VectorOf<AutoDiff> depth;   ///< w, m
  VectorOf<AutoDiff> slope;   ///< r
  MatrixOf<AutoDiff> common;  ///< φᵀ φ between contacts
};
struct MovingComplianceForces {
  VectorOf<AutoDiff> compression;  ///< λ, m
  MatrixOf<AutoDiff> together;     ///< H
};

/// Solves for the forces of contacts if it is known which of them push. Their H
/// changes with C = φᵀ φ + 1/r by −H dC H.
MovingComplianceForces SolveSkin(const MovingCompression& skin,
                                 const std::vector<char>& is_pushing);

}  // namespace drake_haptics
