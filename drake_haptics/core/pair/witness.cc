#include "pair/witness.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "convex/flush_features.h"

namespace drake_haptics {
namespace {

struct Segment {
  Vec3 p, q;
};

Segment EdgeOfA(const PosedPair& pair, Feature feature) {
  const auto& edge = pair.A.edges[feature.index()];
  return {pair.a(edge.v0), pair.a(edge.v1)};
}

Segment EdgeOfB(const PosedPair& pair, Feature feature) {
  const auto& edge = pair.B.edges[feature.index()];
  return {pair.b(edge.v0), pair.b(edge.v1)};
}

// The point of segment s's line that is nearest to the other line.
Vec3 Nearest(const Segment& s, const Segment& other) {
  const Vec3 d = s.q - s.p;
  const Vec3 e = other.q - other.p;
  const Vec3 cross = d.cross(e);
  const double t = (other.p - s.p).cross(e).dot(cross) / cross.squaredNorm();
  return s.p + t * d;
}

Vec3 NearestOn(const Segment& s, const Vec3& point) {
  const Vec3 d = s.q - s.p;
  return s.p + std::clamp((point - s.p).dot(d) / d.squaredNorm(), 0.0, 1.0) * d;
}

// Distance of a point beyond a segment's ends, less the distance allowed beyond
// an end in that direction.
template <typename Allowed>
double OutsideSegment(const Segment& s, const Vec3& point,
                      const Allowed& allowed) {
  const Vec3 d = s.q - s.p;
  const double length = d.norm();
  const double t = (point - s.p).dot(d) / length;
  if (t < 0) return std::max(0.0, -t - allowed(-d / length));
  return t > length ? std::max(0.0, t - length - allowed(d / length)) : 0.0;
}

double OutsideSegment(const Segment& s, const Vec3& point) {
  return OutsideSegment(s, point, [](const Vec3&) { return 0.0; });
}

// Distance of a point (in the polytope's frame) beyond a facet's sides, less
// the distance allowed beyond a side with that outward normal.
template <typename Allowed>
double OutsideFacet(const Polytope& polytope, int facet, const Vec3& point,
                    const Allowed& allowed) {
  const int start = polytope.facet_loop_start[facet];
  const int end = polytope.facet_loop_start[facet + 1];
  double outside = 0;
  for (int k = start; k < end; ++k) {
    const Vec3& corner = polytope.vertices[polytope.facet_loop[k]];
    const Vec3& outward = polytope.facet_loop_side[k];
    const double beyond = outward.dot(point - corner);
    if (beyond > outside)
      outside = std::max(outside, beyond - allowed(outward));
  }
  return outside;
}

double OutsideFacet(const Polytope& polytope, int facet, const Vec3& point) {
  return OutsideFacet(polytope, facet, point, [](const Vec3&) { return 0.0; });
}

}  // namespace

Witness WitnessOfFeatures(const PosedPair& pair, Feature feature_A,
                          Feature feature_B, const Vec3& n, double h) {
  assert(!feature_A.is_none() && !feature_B.is_none());
  if (feature_A.kind() == FeatureKind::kVertex) {
    const Vec3 p_a = pair.a(feature_A.index());
    return {p_a, p_a - h * n};
  }
  if (feature_B.kind() == FeatureKind::kVertex) {
    const Vec3 p_b = pair.b(feature_B.index());
    return {p_b + h * n, p_b};
  }
  const Vec3 p_a = Nearest(EdgeOfA(pair, feature_A), EdgeOfB(pair, feature_B));
  return {p_a, p_a - h * n};
}

Vec3 OnCrossedEdges(const PosedPair& pair, Feature edge_A, Feature edge_B,
                    const Vec3& crossing) {
  const Vec3 p_b = NearestOn(EdgeOfB(pair, edge_B), crossing);
  return NearestOn(EdgeOfA(pair, edge_A), p_b);
}

double LateralOffset(const PosedPair& pair, Feature feature_A,
                     Feature feature_B, const Witness& witness) {
  if (feature_B.kind() == FeatureKind::kFacet) {
    return OutsideFacet(pair.B, feature_B.index(),
                        pair.X_AB.inverse() * witness.p_b);
  }
  if (feature_A.kind() == FeatureKind::kFacet) {
    return OutsideFacet(pair.A, feature_A.index(), witness.p_a);
  }
  return std::max(OutsideSegment(EdgeOfA(pair, feature_A), witness.p_a),
                  OutsideSegment(EdgeOfB(pair, feature_B), witness.p_b));
}

double LateralOffsetOutOfWalls(const PosedPair& pair, Feature feature_A,
                               Feature feature_B, const Vec3& n,
                               const Witness& witness,
                               std::span<const Vec3> translation_vectors) {
  // Largest displacement of A, by any way out, against a direction in A's
  // frame.
  const auto back = [&](const Vec3& along) {
    double farthest = 0;
    for (const Vec3& way : translation_vectors) {
      if (n.dot(way) > kFlush * way.norm()) continue;
      farthest = std::max(farthest, -along.dot(way));
    }
    return farthest;
  };
  const auto back_A = [&](const Vec3& outward) { return back(-outward); };
  if (feature_B.kind() == FeatureKind::kFacet) {
    return OutsideFacet(
        pair.B, feature_B.index(), pair.X_AB.inverse() * witness.p_b,
        [&](const Vec3& outward) { return back(pair.X_AB.R * outward); });
  }
  if (feature_A.kind() == FeatureKind::kFacet) {
    return OutsideFacet(pair.A, feature_A.index(), witness.p_a, back_A);
  }
  return std::max(OutsideSegment(EdgeOfA(pair, feature_A), witness.p_a, back_A),
                  OutsideSegment(EdgeOfB(pair, feature_B), witness.p_b, back));
}

}  // namespace drake_haptics
