#pragma once

#include "base/types.h"

namespace drake_haptics {

/// Length (m) that relates torques to forces and rotations to displacements at
/// a handle: half the width of a hand.
inline constexpr double kHandleLength = 0.05;

/// Returns the nearest matrix that generates no energy: the symmetric part of a
/// stiffness or damping [rotation; translation], with negative eigenvalues set
/// to zero. An unsymmetric spring generates energy around a closed path, one
/// with a negative eigenvalue along a straight one. "Nearest" measures
/// rotations at `kHandleLength`, so that all entries have one unit.
/// @param changed set to true if the change exceeds round-off; else left.
Mat6 ProjectToPositiveSemidefinite(const Mat6& matrix, bool* changed);

}  // namespace drake_haptics
