#pragma once

#include <optional>

#include "contact_patch.h"
#include "depth_walk.h"
#include "pair_state.h"
#include "support.h"
#include "types.h"

namespace drake_haptics {

/// How the answer of a pair was reached.
enum class ContactStatus : std::int32_t {
  kNear = 0,         ///< apart; closest features
  kPenetrating = 1,  ///< overlapping; locally optimal depth
  kHeld = 2,         ///< passed behind the surface it had pressed on
  kBounded = 3       ///< a search met its bound; best answer seen
};

/// One contact of a pair of polytopes, in A's frame. Signs are those of
/// Drake's SignedDistancePair.
struct PairContact {
  double distance = 0;      ///< m; negative is the penetration depth
  Vec3 n = Vec3::UnitX();   ///< unit, from B into A
  Vec3 p_a = Vec3::Zero();  ///< witness point of A, m
  Vec3 p_b = Vec3::Zero();  ///< witness point of B: p_a − p_b = distance · n
  Feature feature_A;
  Feature feature_B;
  ContactStatus status = ContactStatus::kNear;
};

/// Buffers of a query, kept between ticks so that a warm one allocates nothing.
struct PairWorkspace {
  DepthWorkspace depth;
  PatchWorkspace patch;
};

/// Answers the pair at its present pose, warm from `state`, and renews it.
/// Apart: the distance and closest features. Overlapping: the locally optimal
/// penetration depth (paper, 5.2), tracked from the last answer. The two join
/// at zero, where the larger support gap of both is the answer.
///
/// Under kSurfaceOnly a contact apart counts where both meshes are locally
/// supported along its normal, so that seams of a decomposition are never
/// felt; a contact's depth grows no faster than the motion allows; a pair that
/// was in contact and has passed behind the surface stays in contact along the
/// way it went in; and where the tool slides from one piece to the next while
/// it presses, the next takes the contact over at its depth.
///
/// The witness points of faces that lie nearly flush are at the centre of
/// pressure of a layer as thick as `tolerance` − distance, at most a tenth of
/// the tolerance (contact_patch.h); a thousandth of the size where the
/// tolerance is infinite.
std::optional<PairContact> QueryPair(const PosedPair& pair,
                                     const PairRequest& request,
                                     PairState* state,
                                     PairWorkspace* workspace);

}  // namespace drake_haptics
