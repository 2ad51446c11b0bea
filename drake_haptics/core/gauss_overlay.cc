#include "gauss_overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drake_haptics {
namespace {

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

// Whether the arc of an edge may hold a direction whose gap with w exceeds the
// floor. Along an arc the gap is a cosine, convex where it is negative, and so
// is largest at an end. `sign` turns the facets' normals into directions.
bool ArcMayExceed(const Polytope& P, int id, const Vec3& w, double sign,
                  double floor) {
  const Polytope::Edge& edge = P.edges[id];
  return edge.left < 0 || sign * P.facets[edge.left].normal.dot(w) > floor ||
         sign * P.facets[edge.right].normal.dot(w) > floor || floor >= 0;
}

// The overlay at one hub. Edge vectors are made on first use: while a good
// answer is known, most hubs have nothing to offer above its gap.
class Overlay {
 public:
  Overlay(const PosedPair& pair, const Hub& hub, double floor,
          DepthWorkspace* workspace)
      : pair_(pair),
        hub_(hub),
        floor_(floor),
        workspace_(*workspace),
        w_(pair.a(hub.a) - pair.b(hub.b)),
        w_B_(pair.X_AB.R.transpose() * w_) {}

  void AddFacetsOfA() {
    for (const int f : pair_.A.facets_of(hub_.a)) {
      const Vec3 n = -pair_.A.facets[f].normal;
      const double h = n.dot(w_);
      if (h > floor_ && IsInRegionOfB(n)) {
        Append(h, n, {FeatureKind::kFacet, f}, {FeatureKind::kVertex, hub_.b});
      }
    }
  }

  void AddFacetsOfB() {
    for (const int f : pair_.B.facets_of(hub_.b)) {
      const double h = pair_.B.facets[f].normal.dot(w_B_);
      if (!(h > floor_)) continue;
      const Vec3 n = pair_.X_AB.R * pair_.B.facets[f].normal;
      if (IsInRegionOfA(n)) {
        Append(h, n, {FeatureKind::kVertex, hub_.a}, {FeatureKind::kFacet, f});
      }
    }
  }

  void AddEdgePairs() {
    const auto ids_A = pair_.A.neighbor_edges_of(hub_.a);
    const auto ids_B = pair_.B.neighbor_edges_of(hub_.b);
    std::vector<int>& active_B = workspace_.active_B;
    active_B.clear();
    for (std::size_t j = 0; j < ids_B.size(); ++j) {
      if (ArcMayExceed(pair_.B, ids_B[j], w_B_, 1.0, floor_)) {
        active_B.push_back(static_cast<int>(j));
      }
    }
    if (active_B.empty()) return;
    for (std::size_t i = 0; i < ids_A.size(); ++i) {
      if (!ArcMayExceed(pair_.A, ids_A[i], w_, -1.0, floor_)) continue;
      FillEdges();
      for (const int j : active_B) {
        AddEdgePair(workspace_.edges_A[i], ids_A[i], workspace_.edges_B[j],
                    ids_B[j]);
      }
    }
  }

 private:
  void FillEdges() {
    if (filled_) return;
    filled_ = true;
    workspace_.edges_A.clear();
    workspace_.edges_B.clear();
    for (const int v : pair_.A.neighbors_of(hub_.a)) {
      workspace_.edges_A.push_back(pair_.A.vertices[v] -
                                   pair_.A.vertices[hub_.a]);
    }
    for (const int v : pair_.B.neighbors_of(hub_.b)) {
      workspace_.edges_B.push_back(
          pair_.X_AB.R * (pair_.B.vertices[v] - pair_.B.vertices[hub_.b]));
    }
  }

  // n is in the region of A's vertex when no neighbour lies further against n.
  bool IsInRegionOfA(const Vec3& n) {
    FillEdges();
    const double slack = kRegionSlack * pair_.A.radius;
    return std::all_of(workspace_.edges_A.begin(), workspace_.edges_A.end(),
                       [&](const Vec3& e) { return n.dot(e) >= -slack; });
  }

  // n is in the region of B's vertex when no neighbour lies further along n.
  bool IsInRegionOfB(const Vec3& n) {
    FillEdges();
    const double slack = kRegionSlack * pair_.B.radius;
    return std::all_of(workspace_.edges_B.begin(), workspace_.edges_B.end(),
                       [&](const Vec3& e) { return n.dot(e) <= slack; });
  }

  void AddEdgePair(const Vec3& edge_A, int id_A, const Vec3& edge_B, int id_B) {
    if (!ArcMayCross(pair_.B, id_B, pair_.X_AB.R.transpose() * edge_A) ||
        !ArcMayCross(pair_.A, id_A, edge_B)) {
      return;
    }
    const Vec3 cross = edge_A.cross(edge_B);
    const double length_squared = cross.squaredNorm();
    if (!(length_squared > kParallelSine * kParallelSine *
                               edge_A.squaredNorm() * edge_B.squaredNorm())) {
      return;
    }
    const double length = std::sqrt(length_squared);
    for (const double sign : {1.0, -1.0}) {
      const Vec3 n = cross * (sign / length);
      const double h = n.dot(w_);
      if (h > floor_ && IsInRegionOfA(n) && IsInRegionOfB(n)) {
        Append(h, n, {FeatureKind::kEdge, id_A}, {FeatureKind::kEdge, id_B});
      }
    }
  }

  void Append(double h, const Vec3& n, Feature a, Feature b) {
    workspace_.candidates.push_back(
        {h, n, a, b,
         ClassifySupport(pair_.A, a, n, pair_.B, b,
                         pair_.X_AB.R.transpose() * n)});
  }

  const PosedPair& pair_;
  const Hub hub_;
  const double floor_;
  DepthWorkspace& workspace_;
  const Vec3 w_;    // the vertex of A ⊖ B, in A's frame
  const Vec3 w_B_;  // the same in B's frame
  bool filled_ = false;
};

}  // namespace

void OverlayGaussRegions(const PosedPair& pair, const Hub& hub, double floor,
                         DepthWorkspace* workspace) {
  Overlay overlay(pair, hub, floor, workspace);
  overlay.AddFacetsOfA();
  overlay.AddFacetsOfB();
  overlay.AddEdgePairs();
}

}  // namespace drake_haptics
