#pragma once

#include <vector>

#include "convex/support.h"
#include "pair/global_depth.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// The shallowest of all facets of A ⊖ B (global_depth.h), virtual or not, with
/// its support by the surfaces. kNoFacet where A ⊖ B has no interior.
/// @param start a vertex pair to walk from.
Depth LeastOfAllFacets(const PosedPair& pair, const MinkowskiVertex& start,
                       GlobalDepthState* state);

/// Lists all facets of A ⊖ B that both surfaces carry and whose gap exceeds
/// `floor` (m), the shallowest first: by enumeration, not by a walk, so that
/// none is missed wherever virtual facets lie between.
///
/// Each original facet of a body faces the vertices of the other that support
/// it; two original edges make a facet where their arcs on the Gauss map cross.
/// It costs two products for most pairs of edges.
void ListSupportedFacetsByBruteForce(const PosedPair& pair, double floor,
                                     std::vector<DepthCandidate>* facets);

}  // namespace drake_haptics
