#pragma once

#include "convex/polytope.h"

namespace drake_haptics {

/// Fills `hidden` and `hidden_start` of a solid: the edges that the exact hull
/// of its vertices has inside of facets. A facet is flat only within a
/// tolerance. Where two of its corners are no farther apart than that, their
/// edges do not tell how the facet goes on, and a search that climbs along the
/// edges may end at a vertex that is not the farthest. On the edges of the
/// exact hull there is no such vertex.
void FillHiddenEdges(Polytope* P);

}  // namespace drake_haptics
