#pragma once

#include <array>
#include <cstdint>

#include "base/types.h"

namespace drake_haptics {

/// How the answer of a pair was reached.
enum class ContactStatus : std::int32_t {
  kNear = 0,         ///< apart; closest features
  kPenetrating = 1,  ///< overlapping; penetration depth
  kHeld = 2,         ///< passed behind the surface it had pressed on
  kBounded = 3       ///< a search met its bound; best answer seen
};

/// One contact of a pair of polytopes, in A's frame. Signs are those of
/// Drake's SignedDistancePair.
struct PairContact {
  double distance = 0;      ///< m; if negative, minus the penetration depth
  Vec3 n = Vec3::UnitX();   ///< unit, from B into A
  Vec3 p_a = Vec3::Zero();  ///< witness point of A, m
  Vec3 p_b = Vec3::Zero();  ///< witness point of B: p_a − p_b = distance · n
  Feature feature_A;
  Feature feature_B;
  ContactStatus status = ContactStatus::kNear;
  double extent = 0;     ///< measure of the overlap, m² (contact_patch.h)
  double flushness = 0;  ///< share of the contact in flush faces and edges
  /// Support vertices of A and B along n.
  std::array<std::int32_t, 2> support{};
};

}  // namespace drake_haptics
