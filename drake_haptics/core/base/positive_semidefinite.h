#pragma once

#include "base/types.h"

namespace drake_haptics {

/// Length (m) by which forces and torques, turns and displacements are compared
/// at a handle: half the width of a hand.
inline constexpr double kHandleLength = 0.05;

/// The nearest matrix that gives no energy: of the symmetric part of a
/// stiffness or damping [rotation; translation] what has no negative
/// eigenvalue. An unsymmetric spring gives energy around a closed path, one
/// with a negative eigenvalue along a straight one. Nearest is meant with turns
/// measured at `kHandleLength`, so that all entries have one unit.
/// @param changed set to true if more than round-off was taken away; else left.
Mat6 ProjectToPositiveSemidefinite(const Mat6& matrix, bool* changed);

}  // namespace drake_haptics
