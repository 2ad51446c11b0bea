#include "tracker/closest_feature_replacement.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "pair/gauss_overlay.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

// Cosine of the largest angle between the direction of the closest points and
// the normal of the facet that replaces them.
constexpr double kLargestPromotion = 0.5;
// Its square, less some round-off.
constexpr double kSurelyTurned = 0.2499;
// Round-off of positions, as a share of the size.
constexpr double kRoundOff = 1e-12;

// Whether an earlier corner of the simplex is on the same vertex of a body.
bool IsRepeated(const Simplex& simplex, int corner,
                int MinkowskiVertex::* side) {
  const auto begin = simplex.vertex_pairs.begin();
  return std::any_of(
      begin, begin + corner, [&](const MinkowskiVertex& vertex_pair) {
        return vertex_pair.*side == simplex.vertex_pairs[corner].*side;
      });
}

class Search {
 public:
  Search(const PosedPair& pair, const Separation& separation,
         const SurfaceRequest& request)
      : pair_(pair),
        separation_(separation),
        n_B_(pair.X_AB.R.transpose() * separation.n),
        request_(request) {}

  Promotion Run() {
    for (int i = 0; i < simplex().size; ++i) {
      const MinkowskiVertex& corner = simplex().vertex_pairs[i];
      if (!IsRepeated(simplex(), i, &MinkowskiVertex::a)) {
        for (const Polytope::OneRingEntry& ring_entry :
             pair_.A.fan_of(corner.a)) {
          ConsiderFacetOfA(ring_entry, corner);
        }
      }
      if (IsRepeated(simplex(), i, &MinkowskiVertex::b)) continue;
      for (const Polytope::OneRingEntry& ring_entry :
           pair_.B.fan_of(corner.b)) {
        ConsiderFacetOfB(ring_entry, corner);
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

  // Before the gap is found, the farthest vertex of B below the plane of A's
  // facet bounds it. Virtual facets carry no contact, and B carries none along
  // directions outside its normal cone.
  void ConsiderFacetOfA(const Polytope::OneRingEntry& ring_entry,
                        MinkowskiVertex vertex_pair) {
    const Vec3 n = -ring_entry.normal;
    if (n.dot(separation_.n) < kLargestPromotion) return;
    const Polytope::Facet& face = pair_.A.facets[ring_entry.facet];
    if (!face.original) return;
    const Vec3 n_B = pair_.X_AB.R.transpose() * n;
    if (!pair_.B.normal_cone.Holds(n_B)) return;
    vertex_pair.b = SupportVertex(pair_.B, n_B, vertex_pair.b);
    if (!MayBeWidest(face.normal.dot(pair_.b(vertex_pair.b)) - face.offset)) {
      return;
    }
    const double h = SupportGap(pair_, n, &vertex_pair);
    if (!IsWanted(h)) return;
    Consider(n, h, {FeatureKind::kFacet, ring_entry.facet},
             {FeatureKind::kVertex, vertex_pair.b}, vertex_pair);
  }

  // The same for a facet of B.
  void ConsiderFacetOfB(const Polytope::OneRingEntry& ring_entry,
                        MinkowskiVertex vertex_pair) {
    if (ring_entry.normal.dot(n_B_) < kLargestPromotion) return;
    const Polytope::Facet& face = pair_.B.facets[ring_entry.facet];
    if (!face.original) return;
    const Vec3 n = pair_.X_AB.R * ring_entry.normal;
    if (!pair_.A.normal_cone.Holds(-n)) return;
    vertex_pair.a = SupportVertex(pair_.A, -n, vertex_pair.a);
    if (!MayBeWidest(n.dot(pair_.a(vertex_pair.a) - pair_.X_AB.p) -
                     face.offset)) {
      return;
    }
    const double h = SupportGap(pair_, n, &vertex_pair);
    if (!IsWanted(h)) return;
    Consider(n, h, {FeatureKind::kVertex, vertex_pair.a},
             {FeatureKind::kFacet, ring_entry.facet}, vertex_pair);
  }

  bool MayBeWidest(double bound) const {
    return bound > found_.facet.h - Tie(pair_);
  }
  bool IsWanted(double h) const {
    return h > found_.facet.h && !(h > request_.tolerance);
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
    // Most edges cross at another angle: no root is needed to see it.
    const double facing = cross.dot(separation_.n);
    if (facing * facing < kSurelyTurned * cross.squaredNorm()) return;
    const double length = cross.norm();
    if (!(length > kParallelSine * a.along.norm() * along_b.norm())) return;
    const Vec3 n = cross * ((facing > 0 ? 1.0 : -1.0) / length);
    const double h = n.dot(w);
    if (n.dot(separation_.n) < kLargestPromotion || !IsWanted(h)) return;
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
  const Vec3 n_B_;  // its normal in B's frame
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
