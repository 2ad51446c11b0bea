#pragma once

#include <limits>
#include <optional>

#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Lower bound of the gap where any depth counts, m.
inline constexpr double kNoFloor = -std::numeric_limits<double>::infinity();

/// Whether A lay in front of a facet of A ⊖ B at the last pose: an overlap that
/// began since then may have begun there, however deep it is now. The facet's
/// plane moves with the body that has the facet, or with B where two edges make
/// it.
bool LayInFront(const PosedPair& pair, const DepthCandidate& facet,
                const Pose& last_X_AB);

/// Largest motion of a point of either piece since the last pose, seen from the
/// other piece, m: no way in was longer.
double LongestWay(const PosedPair& pair, const Pose& last_X_AB);

/// Finds the facet of A ⊖ B through which two overlapping pieces came together:
/// the shallowest one that both surfaces carry, in front of which A lay at the
/// last pose, and on whose own features the pieces press. If
/// request.is_any_way_out, the shallowest that both surfaces carry.
///
/// It goes through all features, so that the result depends on the two poses
/// alone and not on the start of a search; facets deeper than the motion are
/// left out early.
/// @pre Both pieces have facets: dimensions of 2 or 3.
/// @param near vertices near which the bodies overlap, for speed only.
std::optional<DepthCandidate> FindEntry(const PosedPair& pair,
                                        const SurfaceRequest& request,
                                        const MinkowskiVertex& near,
                                        SurfacePairWorkspace* workspace);

/// Finds the shallowest way out of an overlap without a known earlier pose: a
/// facet of A ⊖ B that both surfaces carry and on whose own features the pieces
/// press. None if the pieces do not overlap.
std::optional<DepthCandidate> FindWayOut(const PosedPair& pair,
                                         double tolerance,
                                         SurfacePairWorkspace* workspace);

/// Whether an edge of one surface passes through a face of the other: then two
/// solids overlap, wherever the pieces' virtual sides are.
bool DoSurfacesCross(const PosedPair& pair);

}  // namespace drake_haptics
