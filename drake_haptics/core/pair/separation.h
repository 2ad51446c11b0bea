#pragma once

#include "base/types.h"
#include "convex/support.h"
#include "pair/simplex.h"

namespace drake_haptics {

/// Far more rounds than polytopes were seen to need.
inline constexpr int kMaxSeparationRounds = 128;

/// How a separation query ended.
enum class SeparationStatus {
  kApart,    ///< the closest points are exact to round-off
  kBeyond,   ///< apart by more than the limit; the normal proves it
  kTouching  ///< overlapping, or apart by less than round-off
};

/// Closest points of two polytopes, in A's frame.
struct Separation {
  SeparationStatus status = SeparationStatus::kTouching;
  double distance = 0;      ///< m; a lower bound where kBeyond
  Vec3 n = Vec3::UnitX();   ///< unit, from B into A; unset where kTouching
  Vec3 p_a = Vec3::Zero();  ///< closest point of A, m; unset where kBeyond
  Vec3 p_b = Vec3::Zero();  ///< closest point of B, m; unset where kBeyond
  /// If kApart: whether the supports along n prove the distance. Round-off can
  /// end the search earlier.
  bool is_proven = false;
  /// Whether the search met its bound on rounds before the proof: the distance
  /// may be too large, never too small.
  bool is_bounded = false;
  Simplex simplex;  ///< closest features; also the next query's start
};

/// Whether the tetrahedron of four vertices of A ⊖ B still contains the origin,
/// strictly and beyond round-off: then the pair overlaps. False for fewer
/// vertices.
[[nodiscard]] bool HoldsOrigin(const PosedPair& pair,
                               const SimplexVertexPairs& simplex);

/// Computes the distance of the pair by the method of Gilbert, Johnson and
/// Keerthi (1988) on supports that climb from the last answer. Starts from the
/// vertices of `start` (may be empty), evaluated at the present pose. Ends on
/// the duality gap |v| − h(n), on a repeated vertex, or after a bounded number
/// of rounds with the best answer so far. A warm search that ends unproven is
/// repeated from an empty start.
/// @param limit distance (m) beyond which the exact answer is not needed.
[[nodiscard]] Separation ComputeSeparation(
    const PosedPair& pair, const SimplexVertexPairs& start, double limit,
    int max_rounds = kMaxSeparationRounds);

}  // namespace drake_haptics
