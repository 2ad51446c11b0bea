#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Indices, ascending, of the points that are farther than `distance` from
/// every point kept before. Two nearly coincident vertices have an edge without
/// a direction and facets without a normal, over which no search can climb.
std::vector<int> WeldPoints(std::span<const Vec3> points, double distance);

}  // namespace drake_haptics
