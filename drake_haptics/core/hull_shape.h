#pragma once

#include <span>
#include <vector>

#include "polytope.h"
#include "types.h"

namespace drake_haptics {

/// The convex hull of a point set as polygons over its extreme points: what a
/// polytope is made from.
struct HullShape {
  struct Polygon {
    Vec3 normal;            ///< unit, outward
    std::vector<int> loop;  ///< points, counter-clockwise seen from outside
  };
  int dimension = 0;
  std::vector<int> extreme;       ///< indices of the extreme points, ascending
  std::vector<Polygon> polygons;  ///< dimension 2: front and back
};

/// Whether all coordinates are finite and so small that their squares are too.
bool AreUsable(std::span<const Vec3> points);

/// @param points positions, m, finite and at least one.
/// @param tolerance thickness, m, below which the set is flat. The same bound,
///        against a facet's plane, merges triangles to facets. It is never
///        taken below the round-off of the coordinates themselves.
HullShape FindHullShape(std::span<const Vec3> points, double tolerance);

/// The polytope of a shape that was found for the same points: vertex i is the
/// point extreme[i]. Every feature original.
Polytope MakePolytope(std::span<const Vec3> points, const HullShape& shape);

}  // namespace drake_haptics
