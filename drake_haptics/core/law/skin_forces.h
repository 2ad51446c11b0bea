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

/// The forces, over the stiffness, and what SkinCoupling keeps of how they
/// change with the depths.
struct SkinForces {
  Eigen::VectorXd compression;  ///< λ, m
  Eigen::VectorXd slope;        ///< r where λ > 0, else 0
  Eigen::MatrixXd factor;       ///< L, L Lᵀ = 1 + Σ r φ φᵀ over these
};

/// Finds λ >= 0 with y >= w, and y = w where λ > 0: the one minimum of
/// ½ λᵀ y(λ) − wᵀ λ. By block principal pivoting (Júdice and Pires 1994):
/// contacts that would pull are left out, those left out that would be
/// overlapped are taken back. What the skin yields by as a whole, u = Σ φ_a
/// λ_i, is of as many numbers as there are features: the time grows with the
/// contacts, and with the directions and the square of the features.
SkinForces SolveSkin(const Skin& skin);

/// The same with derivatives, under which each contact has a direction of its
/// own.
struct MovingSkin {
  VectorOf<AutoDiff> depth;   ///< w, m
  VectorOf<AutoDiff> slope;   ///< r
  MatrixOf<AutoDiff> common;  ///< φᵀ φ between contacts
};
struct MovingSkinForces {
  VectorOf<AutoDiff> compression;  ///< λ, m
  MatrixOf<AutoDiff> together;     ///< H
};

/// The forces of contacts of which it is known which push. What these bear
/// changes with C = φᵀ φ + 1/r by −H dC H.
MovingSkinForces SolveSkin(const MovingSkin& skin,
                           const std::vector<char>& is_pushing);

}  // namespace drake_haptics
