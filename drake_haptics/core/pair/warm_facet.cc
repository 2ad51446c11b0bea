#include "pair/warm_facet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "convex/gauss_angle_bound.h"
#include "pair/gauss_overlay.h"
#include "pair/minkowski_facet_vertices.h"

namespace drake_haptics {
namespace {

// Reach, m, of the neighbors of vertex v of P beyond it along a direction; for
// neighbors across a facet, less its unevenness.
double Reach(const Polytope& P, int v, const Vec3& direction) {
  double reach = -std::numeric_limits<double>::infinity();
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(v)) {
    reach = std::max(reach, direction.dot(ring_entry.along));
  }
  for (const Polytope::HiddenEdge& edge : P.hidden_of(v)) {
    reach = std::max(reach, direction.dot(edge.along) - Unevenness(P, v, edge));
  }
  return reach;
}

// The least clearance of a point on a facet's plane from the facet's rim;
// negative outside.
double Clearance(const Polytope& P, int facet, const Vec3& point) {
  double clearance = std::numeric_limits<double>::infinity();
  const int start = P.facet_loop_start[facet];
  const int end = P.facet_loop_start[facet + 1];
  for (int k = start; k < end; ++k) {
    const Vec3& corner = P.vertices[P.facet_loop[k]];
    clearance = std::min(clearance, P.facet_loop_side[k].dot(corner - point));
  }
  return clearance;
}

// tan(φ/2) for the largest angle between the direction and the facets around a
// vertex.
double TurnAroundVertex(const Polytope& P, int v, const Vec3& direction) {
  double cosine = 1;
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(v)) {
    cosine = std::min(cosine, direction.dot(ring_entry.normal));
  }
  return P.dimension < 2 ? std::numeric_limits<double>::infinity()
                         : GaussAngleBound(cosine);
}

struct FacetVisit {
  bool is_facet = false;
  bool is_minimum = false;
  double h = 0;
};

// Evaluates a facet of P against vertex v of Q, which is `point_P` in P's
// frame; `outward_Q` is the facet's normal in Q's frame.
FacetVisit Visit(const Polytope& P, int facet, const Polytope& Q, int v,
                 const Vec3& point_P, const Vec3& outward_Q) {
  FacetVisit result;
  const double reach = Reach(Q, v, -outward_Q);
  const double slack = kRegionSlack * Q.radius;
  result.is_facet = reach <= slack;
  if (!result.is_facet) return result;
  const Polytope::Facet& plane = P.facets[facet];
  result.h = plane.normal.dot(point_P) - plane.offset;
  const double depth = -result.h;
  const double clearance = Clearance(P, facet, point_P);
  // If Q lies flush, facets around its other vertices touch this one too.
  const bool is_flush = reach >= -kFlushSlack * Q.radius;
  result.is_minimum =
      clearance > 0 &&
      (clearance > depth * plane.turn ||
       (!is_flush && clearance > depth * TurnAroundVertex(Q, v, -outward_Q)));
  return result;
}

Revisit Finish(const PosedPair& pair, SurfaceRule rule, const FacetVisit& visit,
               const Vec3& n, Feature a, Feature b,
               const MinkowskiVertex& vertex_pair) {
  Revisit result;
  if (!visit.is_facet) return result;
  const NormalConeSupport support =
      rule == SurfaceRule::kWholeBoundary
          ? NormalConeSupport::kSupported
          : ClassifySupport(pair.A, a, n, pair.B, b,
                            pair.X_AB.R.transpose() * n);
  result.facet = {visit.h, n, a, b, support};
  result.vertex_pair = vertex_pair;
  result.status =
      visit.is_minimum ? RevisitStatus::kMinimum : RevisitStatus::kFacet;
  return result;
}

Revisit VisitFacetOfA(const PosedPair& pair, SurfaceRule rule, Feature a,
                      Feature b) {
  const int facet = a.index(), vertex = b.index();
  const Vec3& outward = pair.A.facets[facet].normal;
  const Vec3 outward_B = pair.X_AB.R.transpose() * outward;
  const FacetVisit visit =
      Visit(pair.A, facet, pair.B, vertex, pair.b(vertex), outward_B);
  return Finish(pair, rule, visit, -outward, a, b,
                {pair.A.loop_of(facet)[0], vertex});
}

Revisit VisitFacetOfB(const PosedPair& pair, SurfaceRule rule, Feature a,
                      Feature b) {
  const int facet = b.index(), vertex = a.index();
  const Vec3 n = pair.X_AB.R * pair.B.facets[facet].normal;
  const Vec3 point_B = pair.X_AB.R.transpose() * (pair.a(vertex) - pair.X_AB.p);
  const FacetVisit visit = Visit(pair.B, facet, pair.A, vertex, point_B, n);
  return Finish(pair, rule, visit, n, a, b, {vertex, pair.B.loop_of(facet)[0]});
}

Revisit VisitEdges(const PosedPair& pair, SurfaceRule rule, Feature a,
                   Feature b, const Vec3& n_last) {
  Revisit result;
  const Polytope::Edge& edge_A = pair.A.edges[a.index()];
  const Polytope::Edge& edge_B = pair.B.edges[b.index()];
  const Vec3 start_A = pair.a(edge_A.v0), start_B = pair.b(edge_B.v0);
  const Vec3 along_A = pair.a(edge_A.v1) - start_A;
  const Vec3 along_B = pair.b(edge_B.v1) - start_B;
  const Vec3 cross = along_A.cross(along_B);
  const double length = cross.norm();
  const double length_A = along_A.norm(), length_B = along_B.norm();
  if (!(length > kParallelSine * length_A * length_B)) return result;
  const Vec3 n = cross * ((cross.dot(n_last) < 0 ? -1.0 : 1.0) / length);
  // n is perpendicular to both edges, so one end stands for the whole edge.
  if (!IsFarthest(pair.A, edge_A.v0, -n, kRegionSlack * pair.A.radius) ||
      !IsFarthest(pair.B, edge_B.v0, pair.X_AB.R.transpose() * n,
                  kRegionSlack * pair.B.radius)) {
    return result;
  }
  const Vec3 between = start_B - start_A;
  const double h = -n.dot(between);
  const double scale = length * length;
  const double s = between.cross(along_B).dot(cross) / scale;
  const double t = between.cross(along_A).dot(cross) / scale;
  // The facet is a parallelogram: clearances from its two pairs of sides.
  const double clearance = std::min(std::min(s, 1 - s) * length / length_B,
                                    std::min(t, 1 - t) * length / length_A);
  FacetVisit visit;
  visit.is_facet = true;
  visit.h = h;
  // If one body lies flush, only the other one bounds the turn.
  const auto proves = [&](const Polytope& P, Feature edge,
                          const Vec3& outward) {
    return clearance > -h * P.edges[edge.index()].turn &&
           WidestSupport(P, edge, outward) == edge;
  };
  visit.is_minimum =
      clearance > 0 &&
      (proves(pair.A, a, -n) || proves(pair.B, b, pair.X_AB.R.transpose() * n));
  return Finish(pair, rule, visit, n, a, b, {edge_A.v0, edge_B.v0});
}

}  // namespace

Revisit RevisitFacet(const PosedPair& pair, SurfaceRule rule, Feature feature_A,
                     Feature feature_B, const Vec3& n_last) {
  assert(!feature_A.is_none() && !feature_B.is_none());
  if (feature_A.kind() == FeatureKind::kFacet) {
    return VisitFacetOfA(pair, rule, feature_A, feature_B);
  }
  if (feature_B.kind() == FeatureKind::kFacet) {
    return VisitFacetOfB(pair, rule, feature_A, feature_B);
  }
  return VisitEdges(pair, rule, feature_A, feature_B, n_last);
}

}  // namespace drake_haptics
