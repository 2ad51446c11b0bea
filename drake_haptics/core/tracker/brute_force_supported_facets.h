#pragma once

#include <vector>

#include "convex/support.h"
#include "pair/global_depth.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// Shallowest facet of A ⊖ B (global_depth.h), virtual ones included, with its
/// support by the surfaces. kNoFacet if A ⊖ B has no interior.
/// @param start a vertex pair to walk from.
Depth LeastOfAllFacets(const PosedPair& pair, const MinkowskiVertex& start,
                       GlobalDepthState* state);

/// Lists all facets of A ⊖ B that both surfaces carry and whose gap exceeds
/// `floor` (m), shallowest first. Enumerates instead of walking, so that no
/// facet is hidden behind virtual ones.
///
/// Each original facet of a body faces the vertices of the other that support
/// it; two original edges make a facet where their arcs on the Gauss map cross.
/// Most pairs of edges cost two dot products.
void ListSupportedFacetsByBruteForce(const PosedPair& pair, double floor,
                                     std::vector<DepthCandidate>* facets);

}  // namespace drake_haptics
