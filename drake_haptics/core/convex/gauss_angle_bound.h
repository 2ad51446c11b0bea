#pragma once

#include "convex/polytope.h"

namespace drake_haptics {

/// tan(φ/2) for the largest angle φ between a direction and the corners of a
/// Gauss region, from its cosine. Up to 90° the corners bound the angle to the
/// whole region; beyond, nothing is known and the result is infinite.
double GaussAngleBound(double cosine);

/// Fills `facet_loop_side`, and `turn` of each facet and edge: tan(φ/2) for the
/// largest angle φ between a normal that the feature carries and a normal of
/// any facet that shares a vertex with it. It bounds how far the normals of all
/// facets of a Minkowski difference around one on this feature turn away from
/// its own, and so lets one comparison prove a local minimum
/// (facet_revisit.h). Infinite above 90° and for a segment.
void FillGaussAngleBounds(Polytope* polytope);

}  // namespace drake_haptics
