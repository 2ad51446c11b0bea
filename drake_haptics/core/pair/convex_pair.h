#pragma once

#include "convex/support.h"
#include "pair/global_depth.h"
#include "pair/pair_contact.h"
#include "pair/pair_state.h"

namespace drake_haptics {

/// Answers two convex solids at their present pose, warm from `state`, and
/// renews it. Apart: the distance and closest features. Overlapping: the
/// penetration depth. The two join at zero, where the larger support gap of
/// both is the answer.
///
/// The depth is the locally optimal one (paper, 5.2), tracked from the last
/// answer, or where `global` is given the least one of all (global_depth.h).
///
/// Where faces or a face and an edge lie flush, to a billionth of the size,
/// the witness points are at the center of their overlap (contact_patch.h).
[[nodiscard]] PairContact QueryConvexPair(const PosedPair& pair,
                                          PairState* state,
                                          PairWorkspace* workspace,
                                          GlobalDepthState* global = nullptr);

}  // namespace drake_haptics
