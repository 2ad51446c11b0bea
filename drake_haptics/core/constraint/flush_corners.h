#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"
#include "pair/pressure_polygon.h"

namespace drake_haptics {

/// A point of A that faces B, in A's frame.
struct FacingPoint {
  double distance = 0;      ///< distance to B against the normal, m
  Vec3 p_a = Vec3::Zero();  ///< m
};

/// Appends the corners of the overlap of flush features that are no farther
/// apart than `reach` (m): of two facets, of an edge and a facet, and both ends
/// of two edges that are nearly parallel. Features are flush if the sine of
/// their tilt is below 0.1.
///
/// Two bodies that keep their distance at each corner keep it in between, and
/// do not rock; a single closest point would jump from corner to corner. Each
/// corner is a valid constraint by itself, since along the normal no two points
/// are nearer than the bodies.
/// @param n unit normal from B into A, in A's frame, along which they are
///     separated.
/// @param support support vertices of the pair along n.
void AppendFlushCorners(const PosedPair& pair, const Vec3& n,
                        const MinkowskiVertex& support, double reach,
                        PatchWorkspace* workspace,
                        std::vector<FacingPoint>* corners);

}  // namespace drake_haptics
