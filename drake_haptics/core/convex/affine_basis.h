#pragma once

#include <array>
#include <span>

#include "base/types.h"

namespace drake_haptics {

/// Points that span a set: each is the farthest from the span of those before
/// it.
struct AffineBasis {
  int dimension = 0;  ///< 0 point, 1 segment, 2 flat, 3 solid
  std::array<int, 4> point{0, 0, 0, 0};  ///< first dimension + 1 are valid
};

/// Finds the dimension of a set; a thickness within `tolerance` counts as zero.
/// @param points one or more, normalized for the predicates.
AffineBasis FindAffineBasis(std::span<const Vec3> points, double tolerance);

}  // namespace drake_haptics
