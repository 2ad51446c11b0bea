#include "tracker/beside_wall.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "convex/normal_cone_support.h"
#include "pair/gauss_overlay.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

// Cosine of the largest angle between the direction of the closest points and
// the normal of two edges for which they stand.
constexpr double kLargestTurn = 0.5;
// Round-off of positions, as a share of the size.
constexpr double kRoundOff = 1e-12;

// Whether two original edges, of the vertices of a corner, cross with A moved
// out of the walls.
bool DoCrossOutOfWalls(const PosedPair& pair, const Separation& separation,
                       const MinkowskiVertex& corner,
                       const Polytope::OneRingEntry& a,
                       const Polytope::OneRingEntry& b,
                       std::span<const Vec3> translation_vectors) {
  const Vec3 along_b = pair.X_AB.R * b.along;
  const Vec3 cross = a.along.cross(along_b);
  const double length = cross.norm();
  if (!(length > kParallelSine * a.along.norm() * along_b.norm())) return false;
  const double sign = cross.dot(separation.n) > 0 ? 1.0 : -1.0;
  const Vec3 n = cross * (sign / length);
  const double h = n.dot(pair.a(corner.a) - pair.b(corner.b));
  if (n.dot(separation.n) < kLargestTurn || !(h > 0)) return false;
  MinkowskiVertex vertex_pair = corner;
  if (SupportGap(pair, n, &vertex_pair) < h - Tie(pair)) return false;
  const Feature edge_A(FeatureKind::kEdge, a.edge);
  const Feature edge_B(FeatureKind::kEdge, b.edge);
  if (ClassifySupport(pair.A, edge_A, n, pair.B, edge_B,
                      pair.X_AB.R.transpose() * n) !=
      NormalConeSupport::kSupported) {
    return false;
  }
  return EdgeOffsetOutOfWalls(pair, edge_A, edge_B, n,
                              WitnessOfFeatures(pair, edge_A, edge_B, n, h),
                              translation_vectors) <= kRoundOff * pair.scale();
}

}  // namespace

bool IsClosestAtVertex(const Separation& separation) {
  const auto& vertex_pairs = separation.simplex.vertex_pairs;
  const auto is_one = [&](int MinkowskiVertex::* side) {
    return std::all_of(vertex_pairs.begin(),
                       vertex_pairs.begin() + separation.simplex.size,
                       [&](const MinkowskiVertex& vertex_pair) {
                         return vertex_pair.*side == vertex_pairs[0].*side;
                       });
  };
  return is_one(&MinkowskiVertex::a) || is_one(&MinkowskiVertex::b);
}

bool IsBesideWall(const PosedPair& pair, const Separation& separation,
                  std::span<const Vec3> translation_vectors) {
  if (translation_vectors.empty() || !IsClosestAtVertex(separation)) {
    return false;
  }
  const auto is_edge = [](const Polytope& P) {
    return [&P](const Polytope::OneRingEntry& ring_entry) {
      return ring_entry.edge >= 0 && P.edges[ring_entry.edge].original;
    };
  };
  for (int i = 0; i < separation.simplex.size; ++i) {
    const MinkowskiVertex& corner = separation.simplex.vertex_pairs[i];
    for (const Polytope::OneRingEntry& b : pair.B.fan_of(corner.b)) {
      if (!is_edge(pair.B)(b)) continue;
      for (const Polytope::OneRingEntry& a : pair.A.fan_of(corner.a)) {
        if (is_edge(pair.A)(a) && DoCrossOutOfWalls(pair, separation, corner, a,
                                                    b, translation_vectors)) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace drake_haptics
