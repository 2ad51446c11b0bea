#include "tracker/brute_force_supported_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pair/gauss_overlay.h"

namespace drake_haptics {
namespace {

class Enumeration {
 public:
  Enumeration(const PosedPair& pair, double floor,
              std::vector<DepthCandidate>* facets)
      : pair_(pair), floor_(floor), facets_(*facets) {}

  void Run() {
    for (std::size_t f = 0; f < pair_.A.facets.size(); ++f) AddFacetOfA(f);
    for (std::size_t f = 0; f < pair_.B.facets.size(); ++f) AddFacetOfB(f);
    for (std::size_t e = 0; e < pair_.B.edges.size(); ++e) AddEdgeOfB(e);
  }

 private:
  // An edge with the normals of its two facets, in A's frame. A segment has no
  // facets, and its arc is a full circle.
  struct Arc {
    Arc(const Polytope& P, const Polytope::Edge& edge, const Mat3& R)
        : along(R * (P.vertices[edge.v1] - P.vertices[edge.v0])),
          slack(kRegionSlack * P.radius),
          is_circle(edge.left < 0 || edge.right < 0) {
      if (is_circle) return;
      left = R * P.facets[edge.left].normal;
      right = R * P.facets[edge.right].normal;
    }

    // Whether the arc may cross the great circle perpendicular to `axis`.
    bool MayCross(const Vec3& axis) const {
      if (is_circle) return true;
      const double l = axis.dot(left), r = axis.dot(right);
      return (l <= slack && r >= -slack) || (l >= -slack && r <= slack);
    }

    Vec3 along, left, right;
    double slack;
    bool is_circle;
  };

  void AddFacetOfA(std::size_t f) {
    const Polytope::Facet& facet = pair_.A.facets[f];
    if (!facet.original) return;
    const Vec3 n = -facet.normal;
    MinkowskiVertex vertex_pair{pair_.A.loop_of(f)[0], 0};
    const double h = SupportGap(pair_, n, &vertex_pair);
    if (!(h > floor_)) return;
    for (int j = 0; j < pair_.B.num_vertices(); ++j) {
      if (IsInRegion(pair_.B, j, pair_.X_AB.R.transpose() * -n)) {
        Append(h, n, {FeatureKind::kFacet, static_cast<int>(f)},
               {FeatureKind::kVertex, j});
      }
    }
  }

  void AddFacetOfB(std::size_t f) {
    const Polytope::Facet& facet = pair_.B.facets[f];
    if (!facet.original) return;
    const Vec3 n = pair_.X_AB.R * facet.normal;
    MinkowskiVertex vertex_pair{0, pair_.B.loop_of(f)[0]};
    const double h = SupportGap(pair_, n, &vertex_pair);
    if (!(h > floor_)) return;
    for (int i = 0; i < pair_.A.num_vertices(); ++i) {
      if (IsInRegion(pair_.A, i, n)) {
        Append(h, n, {FeatureKind::kVertex, i},
               {FeatureKind::kFacet, static_cast<int>(f)});
      }
    }
  }

  void AddEdgeOfB(std::size_t e) {
    const Polytope::Edge& edge_B = pair_.B.edges[e];
    if (!edge_B.original) return;
    const Arc b(pair_.B, edge_B, pair_.X_AB.R);
    const Vec3 p_b = pair_.b(edge_B.v0);
    for (std::size_t k = 0; k < pair_.A.edges.size(); ++k) {
      const Polytope::Edge& edge_A = pair_.A.edges[k];
      if (!edge_A.original) continue;
      if (!b.MayCross(pair_.a(edge_A.v1) - pair_.a(edge_A.v0))) continue;
      const Arc a(pair_.A, edge_A, Mat3::Identity());
      if (!a.MayCross(b.along)) continue;
      const Vec3 cross = a.along.cross(b.along);
      const double length = cross.norm();
      if (!(length > kParallelSine * a.along.norm() * b.along.norm())) continue;
      for (const double sign : {1.0, -1.0}) {
        const Vec3 n = cross * (sign / length);
        const double h = n.dot(pair_.a(edge_A.v0) - p_b);
        if (h > floor_ && IsInRegion(pair_.A, edge_A.v0, n) &&
            IsInRegion(pair_.B, edge_B.v0, pair_.X_AB.R.transpose() * -n)) {
          Append(h, n, {FeatureKind::kEdge, static_cast<int>(k)},
                 {FeatureKind::kEdge, static_cast<int>(e)});
        }
      }
    }
  }

  // Whether no neighbor of vertex v lies farther along −n, in P's frame.
  static bool IsInRegion(const Polytope& P, int v, const Vec3& n) {
    return IsFarthest(P, v, -n, kRegionSlack * P.radius);
  }

  void Append(double h, const Vec3& n, Feature a, Feature b) {
    const NormalConeSupport support = ClassifySupport(
        pair_.A, a, n, pair_.B, b, pair_.X_AB.R.transpose() * n);
    if (support == NormalConeSupport::kSupported) {
      facets_.push_back({h, n, a, b, support});
    }
  }

  const PosedPair& pair_;
  const double floor_;
  std::vector<DepthCandidate>& facets_;
};

}  // namespace

Depth LeastOfAllFacets(const PosedPair& pair, const MinkowskiVertex& start,
                       GlobalDepthState* state) {
  const Depth local = WalkDepth(pair, start, SurfaceRule::kWholeBoundary,
                                nullptr, {}, &state->walk);
  const GlobalDepth found = FindGlobalDepth(pair, local, state);
  if (found.status == GlobalDepthStatus::kFlat) return {};
  Depth least = found.ToDepth();
  const Vec3 n_B = pair.X_AB.R.transpose() * least.best.n;
  least.best.support =
      ClassifySupport(pair.A, least.best.feature_A, least.best.n, pair.B,
                      least.best.feature_B, n_B);
  return least;
}

void ListSupportedFacetsByBruteForce(const PosedPair& pair, double floor,
                                     std::vector<DepthCandidate>* facets) {
  facets->clear();
  Enumeration(pair, floor, facets).Run();
  std::sort(facets->begin(), facets->end(),
            [](const DepthCandidate& p, const DepthCandidate& q) {
              return p.h > q.h;
            });
}

}  // namespace drake_haptics
