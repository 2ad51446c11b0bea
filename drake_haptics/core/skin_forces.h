#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "autodiff.h"

namespace drake_haptics {

/// Contacts that press into a common elastic skin, which yields to forces λ by
///   y_i = Σ_j G_ab λ_j + λ_i / r_i,  a and b the directions of i and j.
template <typename T>
struct SkinOf {
  VectorOf<T> depth;                    ///< w, m, above 0
  VectorOf<T> slope;                    ///< r, above 0
  std::vector<std::int32_t> direction;  ///< of each contact
  MatrixOf<T> common;  ///< G between directions, positive semidefinite
};
using Skin = SkinOf<double>;

/// The forces, over the stiffness, and how they change with the depths, as in
/// SkinCouplingOf.
template <typename T>
struct SkinForcesOf {
  VectorOf<T> compression;      ///< λ, m
  VectorOf<T> slope;            ///< r where λ > 0, else 0
  VectorOf<T> direction_slope;  ///< R, sums of these
  MatrixOf<T> together;         ///< N; rows of directions with R = 0 are 0
};
using SkinForces = SkinForcesOf<double>;

/// Finds λ >= 0 with y >= w, and y = w where λ > 0: the one minimum of
/// ½ λᵀ y(λ) − wᵀ λ. By block principal pivoting (Júdice and Pires 1994):
/// contacts that would pull are left out, those left out that would be
/// overlapped are taken back. The equations are those of the directions, each
/// of which is one contact at its mean depth: the time grows with the contacts
/// and with the cube of the directions.
SkinForces SolveSkin(const Skin& skin);

/// The same with derivatives. Which contacts push stays, and N changes by
/// −N d(G + 1/R) N.
SkinForcesOf<AutoDiff> SolveSkin(const SkinOf<AutoDiff>& skin);

}  // namespace drake_haptics
