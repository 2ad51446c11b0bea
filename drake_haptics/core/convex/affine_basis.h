#pragma once

#include <array>
#include <span>

#include "base/types.h"

namespace drake_haptics {

/// Points that span a set: each is the farthest from the span of the former.
struct AffineBasis {
  int dimension = 0;  ///< 0 point, 1 segment, 2 flat, 3 solid
  std::array<int, 4> point{0, 0, 0, 0};  ///< the first dimension + 1 count
};

/// The dimension of a set whose thickness below `tolerance` counts as none.
/// @param points one or more, normalized for the predicates.
AffineBasis FindAffineBasis(std::span<const Vec3> points, double tolerance);

}  // namespace drake_haptics
