#pragma once

#include <array>
#include <span>
#include <vector>

#include "types.h"

namespace drake_haptics {

/// A closed convex surface of triangles. Corner k of a triangle starts its
/// edge k, and neighbor k is the triangle across that edge.
struct HullTriangle {
  std::array<int, 3> vertex;  ///< counter-clockwise seen from outside
  std::array<int, 3> neighbor;
};

/// Exact convex hull of distinct points (quickhull; C. B. Barber, D. P. Dobkin,
/// H. Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996). A point is
/// added only when it is strictly outside, by an exact predicate, so that the
/// horizon is always one simple cycle and no degenerate input can break it.
/// @param points distinct, normalized for the predicates.
/// @param simplex four points that are not coplanar.
std::vector<HullTriangle> ExactConvexHull(std::span<const Vec3> points,
                                          std::array<int, 4> simplex);

/// Exact hull of points in a plane, counter-clockwise, extreme points only
/// (Andrew's monotone chain). Fewer than three when all are collinear.
std::vector<int> ExactConvexPolygon(std::span<const Eigen::Vector2d> points);

}  // namespace drake_haptics
