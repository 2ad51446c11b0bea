#pragma once

#include "convex/support.h"
#include "pair/global_depth.h"
#include "pair/pair_contact.h"
#include "pair/pair_state.h"

namespace drake_haptics {

/// Finds the contact of two convex solids at their present pose, warm-started
/// from `state`, which it updates. Apart: the distance and closest features.
/// Overlapping: the penetration depth. At zero, the one with the larger support
/// gap is the answer.
///
/// The depth is the locally optimal one (paper, 5.2), tracked from the last
/// answer, or the least one of all if `global` is given (global_depth.h).
///
/// If faces, or a face and an edge, are flush to a billionth of the size, the
/// witness points are at the center of their overlap (contact_patch.h).
[[nodiscard]] PairContact QueryConvexPair(const PosedPair& pair,
                                          PairState* state,
                                          PairWorkspace* workspace,
                                          GlobalDepthState* global = nullptr);

}  // namespace drake_haptics
