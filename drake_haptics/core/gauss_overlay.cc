#include "gauss_overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drake_haptics {
namespace {

// A direction may miss a region by this share of the edge's length: corners
// that lie on an arc belong to both sides of it.
constexpr double kRegionSlack = 1e-11;
// Edges at a smaller angle than this have no usable cross product; the facets
// beside them cover its direction.
constexpr double kParallelSine = 1e-8;

// n is in the region of A's vertex when no neighbour lies further against n.
bool InRegionOfA(const std::vector<Vec3>& edges, const Vec3& n, double slack) {
  return std::all_of(edges.begin(), edges.end(),
                     [&](const Vec3& e) { return n.dot(e) >= -slack; });
}

// n is in the region of B's vertex when no neighbour lies further along n.
bool InRegionOfB(const std::vector<Vec3>& edges, const Vec3& n, double slack) {
  return std::all_of(edges.begin(), edges.end(),
                     [&](const Vec3& e) { return n.dot(e) <= slack; });
}

// Whether the arc of edge `id` of P, between the normals of the facets beside
// it, may meet the great circle of directions perpendicular to `axis` (in P's
// frame). Segments have no facets, and their arc is the whole circle.
bool ArcMayCross(const Polytope& P, int id, const Vec3& axis) {
  const Polytope::Edge& edge = P.edges[id];
  if (edge.left < 0) return true;
  const double left = axis.dot(P.facets[edge.left].normal);
  const double right = axis.dot(P.facets[edge.right].normal);
  const double slack = kRegionSlack * P.radius;
  return (left <= slack && right >= -slack) ||
         (left >= -slack && right <= slack);
}

}  // namespace

void OverlayGaussRegions(const PosedPair& pair, const Hub& hub, double floor,
                         DepthWorkspace* workspace) {
  const Polytope& A = pair.A;
  const Polytope& B = pair.B;
  const Mat3& R = pair.X_AB.R;
  const Vec3 w = pair.a(hub.a) - pair.b(hub.b);
  const double slack_A = kRegionSlack * A.radius;
  const double slack_B = kRegionSlack * B.radius;
  const auto neighbors_A = A.neighbors_of(hub.a);
  const auto neighbors_B = B.neighbors_of(hub.b);

  std::vector<Vec3>& edges_A = workspace->edges_A;
  std::vector<Vec3>& edges_B = workspace->edges_B;
  edges_A.clear();
  edges_B.clear();
  for (const int v : neighbors_A) {
    edges_A.push_back(A.vertices[v] - A.vertices[hub.a]);
  }
  for (const int v : neighbors_B) {
    edges_B.push_back(R * (B.vertices[v] - B.vertices[hub.b]));
  }

  const auto append = [&](double h, const Vec3& n, Feature a, Feature b) {
    workspace->candidates.push_back(
        {h, n, a, b, ClassifySupport(A, a, n, B, b, R.transpose() * n)});
  };
  for (const int f : A.facets_of(hub.a)) {
    const Vec3 n = -A.facets[f].normal;
    const double h = n.dot(w);
    if (h > floor && InRegionOfB(edges_B, n, slack_B)) {
      append(h, n, {FeatureKind::kFacet, f}, {FeatureKind::kVertex, hub.b});
    }
  }
  for (const int f : B.facets_of(hub.b)) {
    const Vec3 n = R * B.facets[f].normal;
    const double h = n.dot(w);
    if (h > floor && InRegionOfA(edges_A, n, slack_A)) {
      append(h, n, {FeatureKind::kVertex, hub.a}, {FeatureKind::kFacet, f});
    }
  }
  const auto edge_ids_A = A.neighbor_edges_of(hub.a);
  const auto edge_ids_B = B.neighbor_edges_of(hub.b);
  for (std::size_t i = 0; i < edges_A.size(); ++i) {
    const Vec3& edge_A = edges_A[i];
    const Vec3 axis_B = R.transpose() * edge_A;
    for (std::size_t j = 0; j < edges_B.size(); ++j) {
      const Vec3& edge_B = edges_B[j];
      if (!ArcMayCross(B, edge_ids_B[j], axis_B) ||
          !ArcMayCross(A, edge_ids_A[i], edge_B)) {
        continue;
      }
      const Vec3 cross = edge_A.cross(edge_B);
      const double length_squared = cross.squaredNorm();
      if (!(length_squared > kParallelSine * kParallelSine *
                                 edge_A.squaredNorm() * edge_B.squaredNorm())) {
        continue;
      }
      const double length = std::sqrt(length_squared);
      const double along = cross.dot(w) / length;
      for (const double sign : {1.0, -1.0}) {
        const double h = sign * along;
        if (!(h > floor)) continue;
        const Vec3 n = cross * (sign / length);
        if (InRegionOfA(edges_A, n, slack_A) &&
            InRegionOfB(edges_B, n, slack_B)) {
          append(h, n, {FeatureKind::kEdge, edge_ids_A[i]},
                 {FeatureKind::kEdge, edge_ids_B[j]});
        }
      }
    }
  }
}

}  // namespace drake_haptics
