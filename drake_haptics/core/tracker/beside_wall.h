#pragma once

#include <span>

#include "convex/support.h"
#include "pair/separation.h"

namespace drake_haptics {

/// Whether the closest points of two pieces that are apart are a vertex of one
/// of them: only then may edges end beside them at a wall (IsBesideWall).
bool IsClosestAtVertex(const Separation& separation);

/// Whether closest points that the surfaces do not carry count, because A
/// presses into a wall beside them.
///
/// Where two edges cross, they are a contact within both. One may end at a wall
/// that A presses into, and cross the other beyond its end, in that wall. If
/// they cross within both with A moved out of the wall, the closest points
/// count, so that touching one wall does not lose another: a peg that rocks in
/// a tight hole touches some walls by its edges and the rim's alone, and no
/// facet's plane goes on to these (concave_neighbors.h).
/// @param translation_vectors translations of A (m, in its frame), each out of
///     one wall.
bool IsBesideWall(const PosedPair& pair, const Separation& separation,
                  std::span<const Vec3> translation_vectors);

}  // namespace drake_haptics
