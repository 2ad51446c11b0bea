#pragma once

#include "base/types.h"
#include "convex/support.h"

namespace drake_haptics {

/// Whether the overlay of the Gauss regions at a vertex pair may hold a
/// direction whose gap exceeds `floor` (m, negative): false is a proof that it
/// does not.
///
/// A's region is the cone of the normals around its vertex. A direction in a
/// cone is a combination of the cone's corners with weights that sum to one or
/// more, so if no corner exceeds a negative floor, no direction in the cone
/// does. Corners that exceed it are clipped off along the edges of B that
/// exclude them, until none is left or one is found to lie in B's region too.
/// This takes one or two clips, whereas the whole overlay takes all pairs of
/// edges.
/// @param w the vertex pair's vertex of A ⊖ B, in A's frame, m.
[[nodiscard]] bool OverlayMayExceed(const PosedPair& pair,
                                    const MinkowskiVertex& vertex_pair,
                                    const Vec3& w, double floor);

}  // namespace drake_haptics
