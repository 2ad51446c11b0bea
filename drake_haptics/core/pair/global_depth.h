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
};

/// A triangle of the surface that is nearer than the best facet known.
struct NearTriangle {
  double key = 0;
  int triangle = 0;
  bool operator<(const NearTriangle& other) const { return key > other.key; }
};

/// What a pair keeps between queries of its global depth. It belongs to the two
/// polytopes that it was first used with.
struct GlobalDepthState {
  DepthCertificate surface;
  Pose X_AB;                       ///< at the last query
  double travel = 0;               ///< odometer, m
  GlobalDepth last;                ///< features none if there is no last answer
  int cursor = 0;                  ///< triangle last tried for simplifying
  std::vector<NearTriangle> near;  ///< heap, nearest first
  DepthWorkspace walk;

  /// Forgets the last answer and what proved it.
  void Reset();
};

/// The exact penetration depth of two overlapping polytopes on their own: the
/// distance of the origin to the boundary of C = A ⊖ B.
///
/// The answer is proven by a closed surface S of triangles between points of C
/// that winds once about the origin (inner_surface.h). C is convex, so S is in
/// it. Were all of S at a distance of d or more, a point nearer than d would be
/// wound about as the origin is, whereas S does not wind about a point outside
/// C: the ball of radius d is in C, and the depth is at least d. A facet of C
/// whose plane is at the distance d makes it d. S need not be convex for that,
/// and away from the facet it may be coarse.
///
/// S is kept from query to query. If no point of C has moved by more than m
/// since a triangle was measured at the distance s, the triangle is still s − m
/// away. Its key is s plus the odometer's reading, the sum of the m of all
/// queries, and only triangles whose key less the reading is below d are looked
/// at. The origin can have left S only through a triangle whose bound has
/// fallen to zero; then the crossings of a ray are counted.
///
/// Where S is nearer than the best facet known, the support along that
/// direction raises it, or shows the way to a shallower facet (the expansion of
/// van den Bergen, 2001, on a surface that need not stay convex). S is grown
/// again where that fails, for which the number of raises is bounded.
///
/// A facet within a billionth of the size of the shallowest one stays the
/// answer while it is one, so that ties do not chatter; h is the true one.
/// @param local a local minimum, an upper bound of the depth (WalkDepth).
[[nodiscard]] GlobalDepth FindGlobalDepth(const PosedPair& pair,
                                          const Depth& local,
                                          GlobalDepthState* state);

}  // namespace drake_haptics
