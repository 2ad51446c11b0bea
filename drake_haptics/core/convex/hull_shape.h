#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/types.h"
#include "convex/polytope.h"

namespace drake_haptics {

/// The convex hull of a point set as polygons over its extreme points: what a
/// polytope is made from.
struct HullShape {
  struct Polygon {
    Vec3 normal;            ///< unit, outward
    std::vector<int> loop;  ///< points, counter-clockwise seen from outside
    bool original = true;   ///< on the surface that the hull is a piece of
  };
  int dimension = 0;
  std::vector<int> extreme;       ///< indices of the extreme points, ascending
  std::vector<Polygon> polygons;  ///< dimension 2: front and back
};

/// Whether a triangle of a hull, with its unit normal, lies on the surface that
/// the hull is a piece of.
using SurfaceTest =
    std::function<bool(const std::array<int, 3>& points, const Vec3& normal)>;

/// Whether all coordinates are finite and so small that their squares are too.
bool AreUsable(std::span<const Vec3> points);

/// @param points positions, m, finite and at least one.
/// @param tolerance thickness, m, below which the set is flat. The same bound,
///        against a facet's plane, merges triangles to facets. It is never
///        taken below the round-off of the coordinates themselves.
/// @param is_on_surface for each triangle of a solid hull; none means that all
///        are. Triangles with different answers are not merged.
HullShape FindHullShape(std::span<const Vec3> points, double tolerance,
                        const SurfaceTest& is_on_surface = {});

/// The polytope of a shape that was found for the same points: vertex i is the
/// point extreme[i]. Edges are original, facets as the shape says.
Polytope MakePolytope(std::span<const Vec3> points, const HullShape& shape);

}  // namespace drake_haptics
