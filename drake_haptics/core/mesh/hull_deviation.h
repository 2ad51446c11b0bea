#pragma once

#include <span>

#include "convex/hull_shape.h"
#include "mesh/surface_distance.h"

namespace drake_haptics {

/// How far a hull of points of a surface departs from that surface: a bound, m,
/// above the true value by no more than 5% or `negligible`. It is the larger of
/// - the largest distance of a point of the hull's boundary from the solid (of
///   an open surface: from the surface): what the hull fills, seen from above;
/// - the largest depth below the hull's boundary at which a point of the
///   surface lies in the hull: what it buries.
/// A flat hull has the first alone. A hull that fills a cavity departs by the
/// distance of its middle too.
/// @param limit above it the search ends; what it returns is above it too.
double BoundDeparture(std::span<const Vec3> points, const HullShape& hull,
                      const SurfaceDistance& surface, double limit,
                      double negligible);

}  // namespace drake_haptics
