#pragma once

#include <span>

#include "types.h"

namespace drake_haptics {

/// A penetrating contact of the last tick between any pieces of the same two
/// objects, in B's frame.
struct PressedContact {
  double distance = 0;      ///< m
  Vec3 n = Vec3::UnitX();   ///< unit, from B into A
  Vec3 p_b = Vec3::Zero();  ///< witness point of B, m
};

/// What is asked of a pair of pieces.
struct SurfaceRequest {
  double tolerance = 0;  ///< contacts farther apart than this (m) are none
  /// The pose at the last query, by which the motion of a contact is known.
  Pose last_X_AB;
  /// Where the tool presses already. A pair that was not in contact may take
  /// over there.
  std::span<const PressedContact> pressed{};
};

}  // namespace drake_haptics
