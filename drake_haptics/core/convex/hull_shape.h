#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/types.h"
#include "convex/polytope.h"

namespace drake_haptics {

/// Convex hull of a point set as polygons over its extreme points, from which a
/// polytope is made.
struct HullShape {
  struct Polygon {
    Vec3 normal;            ///< unit, outward
    std::vector<int> loop;  ///< points, counter-clockwise seen from outside
    bool original = true;   ///< lies on the surface that the hull is a piece of
  };
  int dimension = 0;
  std::vector<int> extreme;       ///< indices of the extreme points, ascending
  std::vector<Polygon> polygons;  ///< front and back if the dimension is 2
};

/// Whether a triangle of a hull, with its unit normal, lies on the surface that
/// the hull is a piece of.
using SurfaceTest =
    std::function<bool(const std::array<int, 3>& points, const Vec3& normal)>;

/// Whether all coordinates are finite, and so small that squares of areas are
/// too.
bool AreUsable(std::span<const Vec3> points);

/// @param points positions, m, finite and at least one.
/// @param tolerance thickness, m, below which the set is flat. Triangles within
///        it of a facet's plane are merged into the facet. At least the
///        round-off of the coordinates is used.
/// @param is_on_surface test for each triangle of a solid hull; if empty, all
///        are on the surface. Triangles with different results are not merged.
HullShape FindHullShape(std::span<const Vec3> points, double tolerance,
                        const SurfaceTest& is_on_surface = {});

/// Makes the polytope of a shape that was found for the same points: vertex i
/// is the point extreme[i]. Edges are original, facets as marked in the shape.
Polytope MakePolytope(std::span<const Vec3> points, const HullShape& shape);

}  // namespace drake_haptics
