#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "convex/convex_hull.h"
#include "convex/hull_shape.h"

namespace drake_haptics {

/// Merges the triangles of a hull that are coplanar within `tolerance` (m) into
/// polygons and drops the points inside of polygons and on straight edges.
/// Triangles that are on the surface and triangles that are not stay apart, but
/// for those thinner than the tolerance, which have no plane of their own.
/// A polygon takes the plane of its largest triangle, which supports the whole
/// hull exactly. If the tolerance cannot be met by a valid surface (which only
/// noise of the tolerance's own size can cause) the triangles stay apart.
std::vector<HullShape::Polygon> MergeCoplanar(
    std::span<const Vec3> points, std::span<const HullTriangle> triangles,
    std::span<const std::uint8_t> on_surface, double tolerance);

}  // namespace drake_haptics
