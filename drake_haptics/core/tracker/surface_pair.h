#pragma once

#include <optional>

#include "convex/support.h"
#include "pair/global_depth.h"
#include "pair/pair_contact.h"
#include "tracker/surface_pair_state.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Answers two pieces of decomposed surfaces at their present pose, warm from
/// `state`, and renews it: as QueryConvexPair does, but a contact must be
/// carried by the meshes that the pieces stand for.
///
/// A contact apart counts where both meshes are locally supported along its
/// normal, so that seams of a decomposition are never felt; a contact's depth
/// grows no faster than the motion allows; a pair that was in contact and has
/// passed behind the surface stays in contact along the way it went in; and
/// where the tool slides from one piece to the next while it presses, the next
/// takes the contact over at its depth.
///
/// The depth is the one tracked from the last answer, or where `global` is
/// given the least of all facets that both surfaces carry and on which the
/// bodies meet. What has passed behind the surface overlaps with nothing, and
/// is held by the way in either way.
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
