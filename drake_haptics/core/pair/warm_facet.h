#pragma once

#include <array>
#include <limits>

#include "base/types.h"
#include "convex/support.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// Status of the last answer's facet of A ⊖ B at the present pose.
enum class RevisitStatus {
  kGone,    ///< its features do not face each other any more
  kFacet,   ///< it is a facet, perhaps not the shallowest around
  kMinimum  ///< it is a facet, and none that touches it is shallower
};

struct Revisit {
  RevisitStatus status = RevisitStatus::kGone;
  DepthCandidate facet;
  MinkowskiVertex vertex_pair;  ///< one vertex pair of the facet
  /// Least distance of the origin's foot from the rim, m; negative outside.
  double clearance = -1;
  /// How far (m) the neighbors of the facet's vertex, or of both edges' ends,
  /// rise above its plane; negative if all fall away.
  double reach = std::numeric_limits<double>::infinity();
  /// Vertex pairs of the facet around which the proof does not exclude a
  /// shallower one. Around all of them if there is no list.
  std::array<MinkowskiVertex, 4> open;
  int num_open = 0;
  bool has_list = false;
};

/// Evaluates a facet of A ⊖ B again at the present pose, and proves in O(1),
/// where it can, that it is still a local minimum of the depth.
///
/// The proof: let the origin lie |h| below the facet's plane with its foot
/// inside the facet, at least c from its rim. The plane of a facet that touches
/// this one meets this plane in a line on or outside the rim, so at an angle φ
/// the depth of that facet is at least |h| cos φ + c sin φ, which exceeds |h|
/// when c > |h| tan(φ/2). The largest φ is bounded by the Gauss regions of
/// either body's feature (gauss_angle_bound.h). A facet that touches this one
/// in a vertex pair alone meets it at an angle between those of the two sides
/// there: if both sides are that far away, it is not shallower.
/// @param n_last the facet's last normal, in A's frame; decides the side on
///     which two edges pass each other.
[[nodiscard]] Revisit RevisitFacet(const PosedPair& pair, SurfaceRule rule,
                                   Feature feature_A, Feature feature_B,
                                   const Vec3& n_last);

}  // namespace drake_haptics
