#pragma once

#include <span>

#include "simplex.h"
#include "support.h"
#include "types.h"

namespace drake_haptics {

/// What a pair remembers from one tick to the next.
struct PairState {
  Simplex simplex;        ///< of the last separation query
  Vec3 n = Vec3::Zero();  ///< last normal, in A's frame; zero if none
  Hub hub;                ///< supports along the last normal
  Feature feature_A;      ///< features of the last depth; none if the last
  Feature feature_B;      ///< answer was not a depth
  bool in_contact = false;
  double distance = 0;      ///< last contact's, m
  Vec3 p_b = Vec3::Zero();  ///< its witness point of B, in B's frame, m
};

/// Which contacts of a pair count.
enum class SurfaceRule {
  kWholeBoundary,  ///< the polytopes are the solids: every contact counts
  kSurfaceOnly     ///< the polytopes are pieces of surfaces: a contact must be
                   ///< carried by the meshes that they stand for
};

/// A penetrating contact of the last tick between any pieces of the same two
/// objects, in B's frame.
struct PressedContact {
  double distance = 0;      ///< m
  Vec3 n = Vec3::UnitX();   ///< unit, from B into A
  Vec3 p_b = Vec3::Zero();  ///< witness point of B, m
};

/// What is asked of a pair.
struct PairRequest {
  double tolerance = 0;  ///< contacts farther apart than this (m) are none
  SurfaceRule rule = SurfaceRule::kWholeBoundary;
  /// Under kSurfaceOnly: the pose at the last query, by which the motion of a
  /// contact is known.
  Pose last_X_AB;
  /// Under kSurfaceOnly: where the tool presses already. A pair that was not in
  /// contact may take over there.
  std::span<const PressedContact> pressed{};
};

}  // namespace drake_haptics
