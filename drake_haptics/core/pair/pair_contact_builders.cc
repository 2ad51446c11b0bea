#include "pair/pair_contact_builders.h"

#include "convex/normal_cone_support.h"
#include "pair/witness.h"

namespace drake_haptics {
namespace {

Feature SimplexFeature(const Polytope& polytope,
                       const SimplexVertexPairs& simplex,
                       int MinkowskiVertex::* side, const Vec3& n) {
  int vertices[4];
  for (int i = 0; i < simplex.size; ++i) {
    vertices[i] = simplex.vertex_pairs[i].*side;
  }
  return FeatureOfVertices(polytope, vertices, simplex.size, n);
}

// Vertex number k of three that span the feature.
int AffineBasisVertex(const Polytope& polytope, Feature feature, int k,
                      int far_end) {
  switch (feature.kind()) {
    case FeatureKind::kVertex:
      return feature.index();
    case FeatureKind::kEdge: {
      const Polytope::Edge& edge = polytope.edges[feature.index()];
      return k == far_end ? edge.v1 : edge.v0;
    }
    default: {
      const auto loop = polytope.loop_of(feature.index());
      return loop[loop.size() * k / 3];
    }
  }
}

bool IsBetter(const Depth& second, const Depth& first) {
  if (second.status == DepthStatus::kNoFacet) return false;
  if (first.status == DepthStatus::kNoFacet) return true;
  if (second.best.support != first.best.support) {
    return second.best.support > first.best.support;
  }
  return second.best.h > first.best.h;
}

Depth WalkAlong(const PosedPair& pair, SurfaceRule rule, const Vec3& direction,
                MinkowskiVertex vertex_pair, const WalkBounds& bounds,
                DepthWorkspace* workspace) {
  SupportGap(pair, direction, &vertex_pair);
  return WalkDepth(pair, vertex_pair, rule, nullptr, bounds, workspace);
}

}  // namespace

bool AreBothWanted(const PosedPair& pair, const Separation& separation) {
  const double share = separation.is_proven ? 1e-9 : 1e-6;
  return separation.distance < share * pair.scale();
}

ClosestFeatures FeaturesOfSimplex(const PosedPair& pair,
                                  const SimplexVertexPairs& simplex,
                                  const Vec3& n) {
  return {SimplexFeature(pair.A, simplex, &MinkowskiVertex::a, -n),
          SimplexFeature(pair.B, simplex, &MinkowskiVertex::b,
                         pair.X_AB.R.transpose() * n)};
}

std::array<MinkowskiVertex, 3> SpanningVertices(const PosedPair& pair,
                                                Feature feature_A,
                                                Feature feature_B) {
  std::array<MinkowskiVertex, 3> spanning;
  for (int k = 0; k < 3; ++k) {
    // Two edges span a parallelogram: take three of its corners.
    spanning[k] = {AffineBasisVertex(pair.A, feature_A, k, 1),
                   AffineBasisVertex(pair.B, feature_B, k, 2)};
  }
  return spanning;
}

PairContact ContactApart(const PosedPair& pair, const Separation& separation) {
  const auto [feature_A, feature_B] =
      FeaturesOfSimplex(pair, separation.simplex, separation.n);
  return {
      separation.distance,
      separation.n,
      separation.p_a,
      separation.p_b,
      feature_A,
      feature_B,
      separation.is_bounded ? ContactStatus::kBounded : ContactStatus::kNear};
}

PairContact ContactAtFacet(const PosedPair& pair, const DepthCandidate& facet,
                           ContactStatus status) {
  const Witness witness = WitnessOfFeatures(pair, facet.feature_A,
                                            facet.feature_B, facet.n, facet.h);
  return {facet.h,         facet.n,         witness.p_a, witness.p_b,
          facet.feature_A, facet.feature_B, status};
}

PairContact ContactGrazing(const PosedPair& pair, const Separation& separation,
                           const Vec3& n_last) {
  const Vec3 along = pair.A.num_vertices() > 1
                         ? Vec3(pair.A.vertices[1] - pair.A.vertices[0])
                     : pair.B.num_vertices() > 1 ? Vec3(pair.b(1) - pair.b(0))
                                                 : Vec3::UnitX();
  Vec3 n = n_last - along * (along.dot(n_last) / along.squaredNorm());
  if (!(n.norm() > 1e-6)) n = along.unitOrthogonal();
  n.normalize();
  const auto [feature_A, feature_B] =
      FeaturesOfSimplex(pair, separation.simplex, n);
  return {0.0,
          n,
          separation.p_a,
          separation.p_a,
          feature_A,
          feature_B,
          ContactStatus::kPenetrating};
}

Vec3 BetweenCentroids(const PosedPair& pair) {
  const Vec3 between = pair.A.centroid - pair.X_AB * pair.B.centroid;
  const double length = between.norm();
  return length > 1e-12 * pair.scale() ? Vec3(between / length) : Vec3::UnitX();
}

Depth ColdDepth(const PosedPair& pair, SurfaceRule rule, const Vec3& n_last,
                const MinkowskiVertex& vertex_pair_last,
                const WalkBounds& bounds, DepthWorkspace* workspace) {
  Depth best = WalkAlong(pair, rule, BetweenCentroids(pair), vertex_pair_last,
                         bounds, workspace);
  if (n_last.squaredNorm() > 0) {
    const Depth other =
        WalkAlong(pair, rule, n_last, vertex_pair_last, bounds, workspace);
    if (IsBetter(other, best)) best = other;
  }
  // Round-off can hide every facet from a vertex pair.
  for (int i = 0; i < 6 && best.status == DepthStatus::kNoFacet; ++i) {
    const Vec3 axis = (i < 3 ? 1.0 : -1.0) * Vec3::Unit(i % 3);
    best = WalkAlong(pair, rule, axis, vertex_pair_last, bounds, workspace);
  }
  return best;
}

}  // namespace drake_haptics
