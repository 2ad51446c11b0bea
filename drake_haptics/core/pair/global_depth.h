#pragma once

#include <vector>

#include "base/types.h"
#include "convex/support.h"
#include "pair/depth_certificate.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// How a query of the global depth ended.
enum class GlobalDepthStatus {
  kExact,    ///< proven: no facet of A ⊖ B is shallower
  kBounded,  ///< a bound was met; the shallowest facet seen
  kFlat      ///< A ⊖ B has no interior: a depth of zero
};

struct GlobalDepth {
  GlobalDepthStatus status = GlobalDepthStatus::kBounded;
  DepthCandidate facet;         ///< −facet.h is the depth
  MinkowskiVertex vertex_pair;  ///< one vertex pair of the facet

  /// The same as the end of a walk.
  Depth ToDepth() const {
    return {status == GlobalDepthStatus::kExact ? DepthStatus::kLocalMinimum
                                                : DepthStatus::kBounded,
            facet, facet.h, vertex_pair};
  }
};

/// A triangle of the surface that is nearer than the best facet known.
struct NearTriangle {
  double key = 0;
  int triangle = 0;
  bool operator<(const NearTriangle& other) const { return key > other.key; }
};

/// State of a pair between queries of its global depth. It belongs to the two
/// polytopes that it was first used with.
struct GlobalDepthState {
  DepthCertificate surface;
  Pose X_AB;                       ///< pose at the last query
  double travel = 0;               ///< odometer, m
  GlobalDepth last;                ///< without features if there is no answer
  int cursor = 0;                  ///< triangle last tried for simplifying
  std::vector<NearTriangle> near;  ///< heap, nearest first
  DepthWorkspace walk;

  /// Forgets the last answer and its proof.
  void Reset();
};

/// The exact penetration depth of two overlapping polytopes on their own: the
/// distance of the origin to the boundary of C = A ⊖ B.
///
/// The answer is proven by a closed surface S of triangles between points of C
/// that winds once about the origin (depth_certificate.h). C is convex, so S is
/// in C. If all of S is at a distance of d or more, S winds about each point
/// nearer than d as often as about the origin. But S does not wind about points
/// outside C: so the ball of radius d is in C, and the depth is at least d. A
/// facet of C whose plane is at the distance d makes the depth equal to d. S
/// need not be convex for this, and may be coarse away from the facet.
///
/// S is kept from query to query. If no point of C has moved by more than m
/// since a triangle was measured at the distance s, the triangle is still at
/// least s − m away. Its key is s plus the odometer, the sum of m over all
/// queries, and only triangles whose key less the odometer is below d are
/// measured. The origin can have left S only through a triangle whose bound has
/// fallen to zero; then the crossings of a ray are counted.
///
/// Where S is nearer than the best facet known, the support along that
/// direction raises S or leads to a shallower facet (the expansion of van den
/// Bergen, 2001, on a surface that need not stay convex). The number of raises
/// is bounded; if they fail, S is grown again.
///
/// The last facet stays the answer while it is a facet and its depth is within
/// a billionth of the size of the least one, so that ties do not chatter; h is
/// that of the shallowest facet.
/// @param local a local minimum, an upper bound of the depth (WalkDepth).
[[nodiscard]] GlobalDepth FindGlobalDepth(const PosedPair& pair,
                                          const Depth& local,
                                          GlobalDepthState* state);

}  // namespace drake_haptics
