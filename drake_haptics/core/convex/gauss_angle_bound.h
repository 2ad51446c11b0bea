#pragma once

#include "convex/polytope.h"

namespace drake_haptics {

/// Returns tan(φ/2) for the largest angle φ between a direction and the corners
/// of a Gauss region, given its cosine. Up to 90° the corners bound the angle
/// to the whole region; beyond, they do not and the result is infinite.
double GaussAngleBound(double cosine);

/// Fills `facet_loop_side`, and `turn` of each facet and edge: tan(φ/2) for the
/// largest angle φ between a normal that the feature carries and a normal of
/// any facet that shares a vertex with it. It bounds the angles between the
/// normal of a Minkowski difference's facet on this feature and those of the
/// facets around it, so that one comparison proves a local minimum
/// (warm_facet.h). Infinite above 90° and for a segment.
void FillGaussAngleBounds(Polytope* polytope);

}  // namespace drake_haptics
