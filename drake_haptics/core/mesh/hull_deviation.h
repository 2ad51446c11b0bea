#pragma once

#include <span>

#include "convex/hull_shape.h"
#include "mesh/surface_distance.h"

namespace drake_haptics {

/// Upper bound, m, on the departure of a hull of surface points from their
/// surface, above the true value by no more than 5% or `negligible`. The
/// departure is the larger of
/// - the largest distance of a point of the hull's boundary from the solid (for
///   an open surface: from the surface), where the hull fills space;
/// - the largest depth of a point of the surface below the hull's boundary,
///   where the hull buries surface.
/// For a flat hull only the first counts. For a hull that fills a cavity the
/// distance of its middle counts too.
/// @param limit m; above it the search ends early, with a result above it.
double BoundDeparture(std::span<const Vec3> points, const HullShape& hull,
                      const SurfaceDistance& surface, double limit,
                      double negligible);

}  // namespace drake_haptics
