#pragma once

#include "convex/polytope.h"

namespace drake_haptics {

/// Fills `hidden` and `hidden_start` of a solid: the edges of the exact hull of
/// its vertices that lie inside facets. A facet is flat only within a
/// tolerance. Where two of its corners are no farther apart, their edges do not
/// show the facet's slope, and a search that climbs along edges may end at a
/// vertex that is not the farthest. The edges of the exact hull have no such
/// vertex.
void FillHiddenEdges(Polytope* P);

}  // namespace drake_haptics
