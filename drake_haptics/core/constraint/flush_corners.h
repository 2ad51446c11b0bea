#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"
#include "pair/pressure_polygon.h"

namespace drake_haptics {

/// A point of A that faces a point of B, in A's frame.
struct FacingPoints {
  double distance = 0;                          ///< m
  Vec3 n = Vec3::UnitX();                       ///< unit, from p_b to p_a
  Vec3 p_a = Vec3::Zero(), p_b = Vec3::Zero();  ///< m
};

/// Appends the corners of the overlap of features that face each other flush,
/// where they are no farther apart than `reach` (m): of two facets, of an edge
/// and a facet, and both ends of two edges that are nearly parallel. Flush is
/// what is tilted by less than a sine of 0.1.
///
/// Two bodies that keep their distance at each corner do so in between, and
/// they do not rock: one closest point would jump from corner to corner. Each
/// corner is a valid constraint by itself, since along the normal no two points
/// are nearer than the bodies.
/// @param n unit normal from B into A, in A's frame, along which they are
///     apart.
/// @param support vertices that support the pair along n.
void AppendFlushCorners(const PosedPair& pair, const Vec3& n,
                        const MinkowskiVertex& support, double reach,
                        PatchWorkspace* workspace,
                        std::vector<FacingPoints>* corners);

}  // namespace drake_haptics
