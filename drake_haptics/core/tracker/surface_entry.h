#pragma once

#include <limits>
#include <optional>

#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Gap of a facet, m, for where any depth counts.
inline constexpr double kNoFloor = -std::numeric_limits<double>::infinity();

/// Whether A lay in front of a facet of A ⊖ B at the last pose: an overlap that
/// has come about since then may have begun there, however deep it is by now.
/// The facet's plane moves with the body that has the facet, or with B where
/// two edges make it.
bool LayInFront(const PosedPair& pair, const DepthCandidate& facet,
                const Pose& last_X_AB);

/// How far a point of either piece has moved at most since the last pose, seen
/// from the other one, m: no way in was longer.
double LongestWay(const PosedPair& pair, const Pose& last_X_AB);

/// The facet of A ⊖ B by which two pieces in overlap came together: of all that
/// the surfaces of both carry, in front of which A lay at the last pose, and on
/// whose own features they press, the shallowest. Where any way out will do,
/// the shallowest of all that the surfaces carry.
///
/// It goes through all features, so that it depends on the two poses alone and
/// not on where a search starts; facets deeper than the motion are left out
/// early.
/// @pre Both pieces have facets: dimensions of 2 or 3.
/// @param near vertices near which the bodies overlap, for speed alone.
std::optional<DepthCandidate> FindEntry(const PosedPair& pair,
                                        const SurfaceRequest& request,
                                        const MinkowskiVertex& near,
                                        SurfacePairWorkspace* workspace);

/// The shallowest way out of an overlap of which no earlier pose is known: a
/// facet of A ⊖ B that the surfaces of both carry and on whose own features
/// they press. None where the pieces do not overlap.
std::optional<DepthCandidate> FindWayOut(const PosedPair& pair,
                                         double tolerance,
                                         SurfacePairWorkspace* workspace);

/// Whether an edge of one surface passes through a face of the other: then two
/// solids overlap, whatever the pieces' virtual sides do.
bool DoSurfacesCross(const PosedPair& pair);

}  // namespace drake_haptics
