#pragma once

#include "depth_walk.h"

namespace drake_haptics {

/// Lists the corners of the overlay of the two Gauss regions at a hub (paper,
/// 5.2.3 steps 1 to 3): the facets of A ⊖ B around that vertex of it. Appends
/// to workspace->candidates those whose gap exceeds `floor`.
void OverlayGaussRegions(const PosedPair& pair, const Hub& hub, double floor,
                         DepthWorkspace* workspace);

}  // namespace drake_haptics
