#pragma once

#include <optional>

#include "convex/support.h"
#include "pair/global_depth.h"
#include "pair/pair_contact.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Queries two pieces of decomposed surfaces at their present pose,
/// warm-started from `state`, which it updates: as QueryConvexPair does, but
/// the meshes that the pieces stand for must carry the contact.
///
/// A contact of separate pieces counts where both meshes are locally supported
/// along its normal, so that seams of a decomposition are never felt; a
/// contact's depth grows no faster than the motion allows; a pair that was in
/// contact and has passed behind the surface stays in contact along the way it
/// went in; and where the tool slides from one piece to the next while it
/// presses, the next takes the contact over at its depth.
///
/// The depth is tracked from the last answer or, where `global` is given, is
/// the least over all facets that both surfaces carry and on which the bodies
/// meet. A tool that has passed behind the surface overlaps nothing, and is
/// held along the way in with either depth.
///
/// The witness points of faces that lie nearly flush are at the center of
/// pressure of a layer as thick as `tolerance` − distance, at most a tenth of
/// the tolerance (contact_patch.h).
std::optional<PairContact> QuerySurfacePair(const PosedPair& pair,
                                            const SurfaceRequest& request,
                                            SurfacePairState* state,
                                            SurfacePairWorkspace* workspace,
                                            GlobalDepthState* global = nullptr);

}  // namespace drake_haptics
