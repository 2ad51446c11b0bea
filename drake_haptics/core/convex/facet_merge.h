#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "convex/convex_hull.h"
#include "convex/hull_shape.h"

namespace drake_haptics {

/// Merges the triangles of a hull that are coplanar within `tolerance` (m) into
/// polygons and drops the points inside polygons and on straight edges.
/// Triangles on the surface are not merged with others, except those thinner
/// than the tolerance, which have no plane of their own. A polygon takes the
/// plane of its largest triangle, which supports the whole hull exactly. If no
/// valid surface meets the tolerance (which only noise of the tolerance's own
/// size can cause), the triangles are not merged.
std::vector<HullShape::Polygon> MergeCoplanar(
    std::span<const Vec3> points, std::span<const HullTriangle> triangles,
    std::span<const std::uint8_t> on_surface, double tolerance);

}  // namespace drake_haptics
