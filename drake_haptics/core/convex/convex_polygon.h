#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Exact convex hull of points in a plane, counter-clockwise, extreme points
/// only (Andrew's monotone chain). Fewer than three when all are collinear.
std::vector<int> ExactConvexPolygon(std::span<const Eigen::Vector2d> points);

}  // namespace drake_haptics
