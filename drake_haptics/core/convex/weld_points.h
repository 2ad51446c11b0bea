#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Indices of the points that are farther than `distance` from every one kept
/// before, ascending. Two vertices that are nearly one have an edge without a
/// direction and facets without a normal; nothing can be climbed over them.
std::vector<int> WeldPoints(std::span<const Vec3> points, double distance);

}  // namespace drake_haptics
