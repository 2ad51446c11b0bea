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
  double motion = 0;        ///< how far A has moved past it since, m
  /// It goes on at this tick within the features of its own pieces, so that no
  /// others need to take it over.
  bool is_kept = false;

  /// Notes how the pose has changed since the contact was found.
  void Advance(const Pose& X_AB, const Pose& last_X_AB) {
    p_a = X_AB * p_b;
    motion = (p_a - last_X_AB * p_b).norm();
  }

  /// Whether two pieces are where the contact was, by their boxes.
  bool IsNear(const Polytope& A, const Polytope& B) const {
    const auto is_within = [slack = motion - distance](const Polytope& P,
                                                       const Vec3& point) {
      return ((point - P.low).array() >= -slack).all() &&
             ((P.high - point).array() >= -slack).all();
    };
    return is_within(B, p_b) && is_within(A, p_a);
  }
};

/// What is asked of a pair of pieces.
struct SurfaceRequest {
  double tolerance = 0;  ///< surfaces farther apart (m) have no contact
  /// The surfaces cross and no other contact was found: any way out will do.
  bool is_any_way_out = false;
  /// The pose at the last query, by which the motion of a contact is known, and
  /// the side from which the bodies came together.
  Pose last_X_AB;
  /// Where the tool presses already. A pair that was not in contact may take
  /// over there.
  std::span<const PenetratingContact> pressed{};
  /// Translations of A (m, in its frame), each out of one of the walls that it
  /// presses into at this tick, as far as these are known by now.
  std::span<const Vec3> translation_vectors{};
  /// Bound on the steps of a walk. The search for a first facet that both
  /// surfaces carry has bounds of its own, so that no contact is lost for want
  /// of it.
  int max_walk_steps = WalkBounds{}.max_steps;
  /// No earlier pose is known; last_X_AB is where the bodies may come from.
  bool is_first = false;
};

}  // namespace drake_haptics
