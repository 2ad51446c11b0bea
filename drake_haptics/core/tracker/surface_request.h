#pragma once

#include <span>

#include "base/types.h"
#include "convex/polytope.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// A penetrating contact of the last tick between any pieces of the same two
/// objects, in B's frame.
struct PenetratingContact {
  double distance = 0;      ///< m
  Vec3 n = Vec3::UnitX();   ///< unit, from B into A
  Vec3 p_b = Vec3::Zero();  ///< witness point of B, m
  Vec3 p_a = Vec3::Zero();  ///< the same point now, in A's frame, m
  double motion = 0;        ///< how far A has moved there since, m
  /// It continues at this tick within the features of its own pieces, so that
  /// no others need to take it over.
  bool is_kept = false;

  /// Updates p_a and motion for the pose at this tick.
  void Advance(const Pose& X_AB, const Pose& last_X_AB) {
    p_a = X_AB * p_b;
    motion = (p_a - last_X_AB * p_b).norm();
  }

  /// Whether the boxes of two pieces, widened by depth and motion, hold the
  /// point of the contact.
  bool IsNear(const Polytope& A, const Polytope& B) const {
    const auto is_within = [slack = motion - distance](const Polytope& P,
                                                       const Vec3& point) {
      return ((point - P.low).array() >= -slack).all() &&
             ((P.high - point).array() >= -slack).all();
    };
    return is_within(B, p_b) && is_within(A, p_a);
  }
};

/// Input of a query of two surface pieces.
struct SurfaceRequest {
  double tolerance = 0;  ///< surfaces farther apart (m) have no contact
  /// The surfaces cross and no other contact was found: any way out counts.
  bool is_any_way_out = false;
  /// Pose at the last query. It tells the motion of a contact and the side from
  /// which the bodies came together.
  Pose last_X_AB;
  /// Contacts of the last tick that press. A pair that was not in contact may
  /// take them over.
  std::span<const PenetratingContact> pressed{};
  /// Translations of A (m, in its frame), each out of one wall that it presses
  /// into at this tick, for the walls known so far.
  std::span<const Vec3> translation_vectors{};
  /// Bound on the steps of a walk. The search for a first facet that both
  /// surfaces carry has its own bounds, so that this one loses no contact.
  int max_walk_steps = WalkBounds{}.max_steps;
  /// No earlier pose is known; last_X_AB is where the bodies may have come
  /// from.
  bool is_first = false;
};

}  // namespace drake_haptics
