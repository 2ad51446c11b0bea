#pragma once

#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// A direction may miss a Gauss region by this share of the polytope's radius:
/// a corner on an arc belongs to both sides.
inline constexpr double kRegionSlack = 1e-11;

/// Edges at a smaller angle than this have no usable cross product; the facets
/// beside them cover that direction.
inline constexpr double kParallelSine = 1e-8;

/// Difference in depth (m) within which two facets are a tie, and a walk stays
/// where it is.
inline double Tie(const PosedPair& pair) { return 1e-12 * pair.scale(); }

/// Lists the corners of the overlay of the two Gauss regions at a vertex pair
/// (paper, 5.2.3 steps 1 to 3): the facets of A ⊖ B around that vertex. Appends
/// to workspace->candidates those whose gap exceeds `floor` (m); each supported
/// one raises the floor.
void OverlayGaussRegions(const PosedPair& pair,
                         const MinkowskiVertex& vertex_pair, SurfaceRule rule,
                         double floor, DepthWorkspace* workspace);

}  // namespace drake_haptics
