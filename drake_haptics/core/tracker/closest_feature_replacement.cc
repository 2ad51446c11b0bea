#include "tracker/closest_feature_replacement.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "pair/gauss_overlay.h"
#include "pair/witness.h"
#include "tracker/feature_replacement_reject.h"

namespace drake_haptics {
namespace {

// Cosine of the largest angle between the direction of the closest points and
// the normal of the facet that replaces them.
constexpr double kLargestPromotion = 0.5;
// Round-off of positions, as a share of the size.
constexpr double kRoundOff = 1e-12;

class Search {
 public:
  Search(const PosedPair& pair, const Separation& separation,
         const SurfaceRequest& request)
      : pair_(pair), separation_(separation), request_(request) {}

  Promotion Run() {
    for (int i = 0; i < simplex().size; ++i) {
      const MinkowskiVertex& corner = simplex().vertex_pairs[i];
      if (!IsRepeated(simplex(), i, &MinkowskiVertex::a)) {
        for (const Polytope::OneRingEntry& ring_entry :
             pair_.A.fan_of(corner.a)) {
          ConsiderFacet(-ring_entry.normal, ring_entry.facet, true);
        }
      }
      if (IsRepeated(simplex(), i, &MinkowskiVertex::b)) continue;
      for (const Polytope::OneRingEntry& ring_entry :
           pair_.B.fan_of(corner.b)) {
        ConsiderFacet(pair_.X_AB.R * ring_entry.normal, ring_entry.facet,
                      false);
      }
    }
    if (found_.facet.support != NormalConeSupport::kSupported &&
        (IsVertex(&MinkowskiVertex::a) || IsVertex(&MinkowskiVertex::b))) {
      ConsiderEndingEdges();
    }
    return found_;
  }

 private:
  const Simplex& simplex() const { return separation_.simplex; }

  void ConsiderFacet(const Vec3& n, int facet, bool is_of_A) {
    if (n.dot(separation_.n) < kLargestPromotion) return;
    MinkowskiVertex vertex_pair = simplex().vertex_pairs[0];
    if (!MayReplaceFeature(pair_, n, facet, is_of_A, vertex_pair,
                           found_.facet.h))
      return;
    const double h = SupportGap(pair_, n, &vertex_pair);
    if (!(h > found_.facet.h) || h > request_.tolerance) return;
    const Feature face(FeatureKind::kFacet, facet);
    const Feature a =
        is_of_A ? face : Feature(FeatureKind::kVertex, vertex_pair.a);
    const Feature b =
        is_of_A ? Feature(FeatureKind::kVertex, vertex_pair.b) : face;
    Consider(n, h, a, b, vertex_pair);
  }

  // Where the closest point is a vertex, an edge may end at the next wall, into
  // which A presses.
  void ConsiderEndingEdges() {
    found_.ends_early = true;
    if (request_.translation_vectors.empty()) return;
    for (int i = 0; i < simplex().size; ++i) {
      const MinkowskiVertex& corner = simplex().vertex_pairs[i];
      const Vec3 w = pair_.a(corner.a) - pair_.b(corner.b);
      for (const Polytope::OneRingEntry& b : pair_.B.fan_of(corner.b)) {
        if (b.edge < 0 || !pair_.B.edges[b.edge].original) continue;
        const Vec3 along_b = pair_.X_AB.R * b.along;
        for (const Polytope::OneRingEntry& a : pair_.A.fan_of(corner.a)) {
          if (a.edge < 0 || !pair_.A.edges[a.edge].original) continue;
          ConsiderEdges(a, b, along_b, w, corner);
        }
      }
    }
  }

  bool IsVertex(int MinkowskiVertex::* side) const {
    const auto& vertex_pairs = simplex().vertex_pairs;
    return std::all_of(vertex_pairs.begin(),
                       vertex_pairs.begin() + simplex().size,
                       [&](const MinkowskiVertex& vertex_pair) {
                         return vertex_pair.*side == vertex_pairs[0].*side;
                       });
  }

  // @param w the vertex of A ⊖ B from which both edges go out.
  void ConsiderEdges(const Polytope::OneRingEntry& a,
                     const Polytope::OneRingEntry& b, const Vec3& along_b,
                     const Vec3& w, const MinkowskiVertex& corner) {
    const Vec3 cross = a.along.cross(along_b);
    const double length = cross.norm();
    if (!(length > kParallelSine * a.along.norm() * along_b.norm())) return;
    const double sign = cross.dot(separation_.n) > 0 ? 1.0 : -1.0;
    const Vec3 n = cross * (sign / length);
    const double h = n.dot(w);
    if (n.dot(separation_.n) < kLargestPromotion || !(h > found_.facet.h) ||
        h > request_.tolerance) {
      return;
    }
    MinkowskiVertex vertex_pair = corner;
    if (SupportGap(pair_, n, &vertex_pair) < h - Tie(pair_)) return;
    Consider(n, h, {FeatureKind::kEdge, a.edge}, {FeatureKind::kEdge, b.edge},
             corner);
  }

  void Consider(const Vec3& n, double h, Feature a, Feature b,
                const MinkowskiVertex& vertex_pair) {
    const NormalConeSupport support = ClassifySupport(
        pair_.A, a, n, pair_.B, b, pair_.X_AB.R.transpose() * n);
    if (support != NormalConeSupport::kSupported) return;
    const Witness witness = WitnessOfFeatures(pair_, a, b, n, h);
    if (LateralOffset(pair_, a, b, witness) > 0) {
      found_.ends_early = true;
      found_.is_beside_wall |=
          LateralOffsetOutOfWalls(pair_, a, b, n, witness,
                                  request_.translation_vectors) <=
          kRoundOff * pair_.scale();
      return;
    }
    found_.facet = {h, n, a, b, support};
    found_.vertex_pair = vertex_pair;
  }

  const PosedPair& pair_;
  const Separation& separation_;
  const SurfaceRequest& request_;
  Promotion found_;
};

}  // namespace

Promotion PromoteClosestPoints(const PosedPair& pair,
                               const Separation& separation,
                               const SurfaceRequest& request) {
  return Search(pair, separation, request).Run();
}

}  // namespace drake_haptics
