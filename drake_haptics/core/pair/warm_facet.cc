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

// Reach, m, of the neighbors of vertex v of P beyond it along a direction, but
// for the neighbor along `edge`; for those across a facet, less its unevenness.
double Reach(const Polytope& P, int v, const Vec3& direction, int edge = -1) {
  double reach = -std::numeric_limits<double>::infinity();
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(v)) {
    if (ring_entry.edge == edge) continue;
    reach = std::max(reach, direction.dot(ring_entry.along));
  }
  for (const Polytope::HiddenEdge& edge : P.hidden_of(v)) {
    reach = std::max(reach, direction.dot(edge.along) - Unevenness(P, v, edge));
  }
  return reach;
}

// Clearance of a point on a facet's plane from side k of the facet loops;
// negative outside.
double Clearance(const Polytope& P, int k, const Vec3& point) {
  return P.facet_loop_side[k].dot(P.vertices[P.facet_loop[k]] - point);
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

// Whether a clearance excludes shallower facets beyond a side: `needed` is the
// depth times the tangent of half the largest angle.
bool IsFar(double clearance, double needed) {
  return clearance > 0 && clearance > needed;
}

Revisit Start(const PosedPair& pair, SurfaceRule rule, double h, const Vec3& n,
              Feature a, Feature b, const MinkowskiVertex& vertex_pair) {
  const NormalConeSupport support =
      rule == SurfaceRule::kWholeBoundary
          ? NormalConeSupport::kSupported
          : ClassifySupport(pair.A, a, n, pair.B, b,
                            pair.X_AB.R.transpose() * n);
  Revisit result;
  result.status = RevisitStatus::kFacet;
  result.facet = {h, n, a, b, support};
  result.vertex_pair = vertex_pair;
  return result;
}

// Lists a vertex pair, or drops the list if it has grown too long.
void AddOpen(const MinkowskiVertex& vertex_pair, Revisit* result) {
  result->has_list &= result->num_open < static_cast<int>(result->open.size());
  if (result->has_list) result->open[result->num_open++] = vertex_pair;
}

// Compares the clearances from the sides of a facet of P with what vertex v of
// Q needs, which is `point_P` in P's frame; `outward_Q` is the facet's normal
// in Q's frame, `reach` that of v's neighbors.
template <typename MakeVertexPair>
void Judge(const Polytope& P, int facet, const Polytope& Q, int v,
           const Vec3& point_P, const Vec3& outward_Q, double reach,
           const MakeVertexPair& make_vertex_pair, Revisit* result) {
  const int start = P.facet_loop_start[facet];
  const int end = P.facet_loop_start[facet + 1];
  double clearance = std::numeric_limits<double>::infinity();
  for (int k = start; k < end; ++k) {
    clearance = std::min(clearance, Clearance(P, k, point_P));
  }
  result->clearance = clearance;
  result->reach = reach;
  const double depth = -result->facet.h;
  double needed = depth * P.facets[facet].turn;
  bool is_minimum = IsFar(clearance, needed);
  // If Q lies flush, facets around its other vertices touch this one too.
  if (!is_minimum && reach < -kFlushSlack * Q.radius) {
    const double around_v = depth * TurnAroundVertex(Q, v, -outward_Q);
    is_minimum = IsFar(clearance, around_v);
    needed = std::min(needed, around_v);
    result->has_list = true;
    bool is_far = IsFar(Clearance(P, end - 1, point_P), needed);
    for (int k = start; k < end; ++k) {
      const bool was_far = is_far;
      is_far = IsFar(Clearance(P, k, point_P), needed);
      if (!was_far || !is_far) {
        AddOpen(make_vertex_pair(P.facet_loop[k]), result);
      }
    }
  }
  if (is_minimum) result->status = RevisitStatus::kMinimum;
}

Revisit VisitFacetOfA(const PosedPair& pair, SurfaceRule rule, Feature a,
                      Feature b) {
  const int facet = a.index(), vertex = b.index();
  const Polytope::Facet& plane = pair.A.facets[facet];
  const Vec3 outward_B = pair.X_AB.R.transpose() * plane.normal;
  const double reach = Reach(pair.B, vertex, -outward_B);
  if (reach > kRegionSlack * pair.B.radius) return {};
  const Vec3 point = pair.b(vertex);
  Revisit result =
      Start(pair, rule, plane.normal.dot(point) - plane.offset, -plane.normal,
            a, b, {pair.A.loop_of(facet)[0], vertex});
  Judge(
      pair.A, facet, pair.B, vertex, point, outward_B, reach,
      [&](int corner) { return MinkowskiVertex{corner, vertex}; }, &result);
  return result;
}

Revisit VisitFacetOfB(const PosedPair& pair, SurfaceRule rule, Feature a,
                      Feature b) {
  const int facet = b.index(), vertex = a.index();
  const Polytope::Facet& plane = pair.B.facets[facet];
  const Vec3 n = pair.X_AB.R * plane.normal;
  const double reach = Reach(pair.A, vertex, -n);
  if (reach > kRegionSlack * pair.A.radius) return {};
  const Vec3 point = pair.X_AB.R.transpose() * (pair.a(vertex) - pair.X_AB.p);
  Revisit result = Start(pair, rule, plane.normal.dot(point) - plane.offset, n,
                         a, b, {vertex, pair.B.loop_of(facet)[0]});
  Judge(
      pair.B, facet, pair.A, vertex, point, n, reach,
      [&](int corner) { return MinkowskiVertex{vertex, corner}; }, &result);
  return result;
}

Revisit VisitEdges(const PosedPair& pair, SurfaceRule rule, Feature a,
                   Feature b, const Vec3& n_last) {
  const Polytope::Edge& edge_A = pair.A.edges[a.index()];
  const Polytope::Edge& edge_B = pair.B.edges[b.index()];
  const Vec3 start_A = pair.a(edge_A.v0), start_B = pair.b(edge_B.v0);
  const Vec3 along_A = pair.a(edge_A.v1) - start_A;
  const Vec3 along_B = pair.b(edge_B.v1) - start_B;
  const Vec3 cross = along_A.cross(along_B);
  const double length = cross.norm();
  const double length_A = along_A.norm(), length_B = along_B.norm();
  if (!(length > kParallelSine * length_A * length_B)) return {};
  const Vec3 n = cross * ((cross.dot(n_last) < 0 ? -1.0 : 1.0) / length);
  // n is perpendicular to both edges, so one end stands for the whole edge.
  const double reach_A = Reach(pair.A, edge_A.v0, -n, a.index());
  if (reach_A > kRegionSlack * pair.A.radius) return {};
  const double reach_B =
      Reach(pair.B, edge_B.v0, pair.X_AB.R.transpose() * n, b.index());
  if (reach_B > kRegionSlack * pair.B.radius) return {};
  const Vec3 between = start_B - start_A;
  const double h = -n.dot(between);
  const double scale = length * length;
  const double s = between.cross(along_B).dot(cross) / scale;
  const double t = between.cross(along_A).dot(cross) / scale;
  // The facet is a parallelogram: clearances from its two pairs of sides.
  const double across_A = length / length_B, across_B = length / length_A;
  const double clearance_A[2] = {s * across_A, (1 - s) * across_A};
  const double clearance_B[2] = {t * across_B, (1 - t) * across_B};
  const double clearance = std::min(
      {clearance_A[0], clearance_A[1], clearance_B[0], clearance_B[1]});
  Revisit result = Start(pair, rule, h, n, a, b, {edge_A.v0, edge_B.v0});
  result.clearance = clearance;
  result.reach = std::max(reach_A, reach_B);
  // If one body lies flush, only the other one bounds the turn.
  const double needed_A = -h * edge_A.turn, needed_B = -h * edge_B.turn;
  const bool is_edge_A = reach_A < -kFlushSlack * pair.A.radius;
  const bool is_edge_B = reach_B < -kFlushSlack * pair.B.radius;
  if ((is_edge_A && IsFar(clearance, needed_A)) ||
      (is_edge_B && IsFar(clearance, needed_B))) {
    result.status = RevisitStatus::kMinimum;
    return result;
  }
  result.has_list = is_edge_A && is_edge_B;
  const double needed = std::min(needed_A, needed_B);
  for (int i = 0; result.has_list && i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      if (IsFar(std::min(clearance_A[i], clearance_B[j]), needed)) continue;
      AddOpen({i == 0 ? edge_A.v0 : edge_A.v1, j == 0 ? edge_B.v0 : edge_B.v1},
              &result);
    }
  }
  return result;
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
