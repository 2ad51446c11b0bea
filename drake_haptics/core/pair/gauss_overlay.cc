#include "pair/gauss_overlay.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <span>

#include "pair/gauss_overlay_reject.h"

namespace drake_haptics {
namespace {

using Fan = std::span<const Polytope::OneRingEntry>;

// The overlay at one vertex pair. The gap of a known answer is the floor:
// candidates below it are skipped. A negative gap along an arc is largest at an
// end.
class Overlay {
 public:
  Overlay(const PosedPair& pair, const MinkowskiVertex& vertex_pair,
          SurfaceRule rule, double floor, DepthWorkspace* workspace)
      : pair_(pair),
        vertex_pair_(vertex_pair),
        rule_(rule),
        floor_(floor),
        workspace_(*workspace),
        fan_A_(pair.A.fan_of(vertex_pair.a)),
        fan_B_(pair.B.fan_of(vertex_pair.b)),
        w_(pair.a(vertex_pair.a) - pair.b(vertex_pair.b)) {}

  void Run() {
    // Once a good answer is known, most vertex pairs have no larger gap.
    if (floor_ < 0 && !OverlayMayExceed(pair_, vertex_pair_, w_, floor_))
      return;
    FillGaps(fan_A_, -w_, &workspace_.gaps_A);
    FillGaps(fan_B_, pair_.X_AB.R.transpose() * w_, &workspace_.gaps_B);
    AddFacetsOfA();
    AddFacetsOfB();
    AddEdgePairs();
  }

 private:
  // Fills in the gap along each facet's normal; infinite on a segment, which
  // has no facets.
  static void FillGaps(Fan fan, const Vec3& w, std::vector<double>* gaps) {
    gaps->resize(fan.size());
    for (std::size_t k = 0; k < fan.size(); ++k) {
      (*gaps)[k] = fan[k].facet < 0 ? std::numeric_limits<double>::infinity()
                                    : fan[k].normal.dot(w);
    }
  }

  void AddFacetsOfA() {
    for (std::size_t k = 0; k < fan_A_.size(); ++k) {
      const double h = workspace_.gaps_A[k];
      if (!(h > floor_) || fan_A_[k].facet < 0) continue;
      const Vec3 n = -fan_A_[k].normal;
      if (IsInRegionOfB(n)) {
        Append(h, n, {FeatureKind::kFacet, fan_A_[k].facet},
               {FeatureKind::kVertex, vertex_pair_.b});
      }
    }
  }

  void AddFacetsOfB() {
    for (std::size_t k = 0; k < fan_B_.size(); ++k) {
      const double h = workspace_.gaps_B[k];
      if (!(h > floor_) || fan_B_[k].facet < 0) continue;
      const Vec3 n = pair_.X_AB.R * fan_B_[k].normal;
      if (IsInRegionOfA(n)) {
        Append(h, n, {FeatureKind::kVertex, vertex_pair_.a},
               {FeatureKind::kFacet, fan_B_[k].facet});
      }
    }
  }

  void AddEdgePairs() {
    if (fan_B_.empty()) return;  // a point
    for (std::size_t i = 0; i < fan_A_.size(); ++i) {
      if (!ArcMayExceed(workspace_.gaps_A, i)) continue;
      const Vec3 edge_A_in_B = pair_.X_AB.R.transpose() * fan_A_[i].along;
      double right = edge_A_in_B.dot(fan_B_.back().normal);
      for (std::size_t j = 0; j < fan_B_.size(); ++j) {
        const double left = edge_A_in_B.dot(fan_B_[j].normal);
        if (MayCross(pair_.B, left, right) &&
            ArcMayExceed(workspace_.gaps_B, j)) {
          const Vec3 edge_B = pair_.X_AB.R * fan_B_[j].along;
          const std::size_t before = Before(i, fan_A_.size());
          if (MayCross(pair_.A, edge_B.dot(fan_A_[i].normal),
                       edge_B.dot(fan_A_[before].normal))) {
            AddEdgePair(fan_A_[i], fan_B_[j], edge_B);
          }
        }
        right = left;
      }
    }
  }

  void AddEdgePair(const Polytope::OneRingEntry& a,
                   const Polytope::OneRingEntry& b, const Vec3& edge_B) {
    const Vec3 cross = a.along.cross(edge_B);
    const double length_squared = cross.squaredNorm();
    if (!(length_squared > kParallelSine * kParallelSine *
                               a.along.squaredNorm() * edge_B.squaredNorm())) {
      return;
    }
    const double length = std::sqrt(length_squared);
    for (const double sign : {1.0, -1.0}) {
      const Vec3 n = cross * (sign / length);
      const double h = n.dot(w_);
      if (h > floor_ && IsInRegionOfA(n) && IsInRegionOfB(n)) {
        Append(h, n, {FeatureKind::kEdge, a.edge},
               {FeatureKind::kEdge, b.edge});
      }
    }
  }

  static std::size_t Before(std::size_t k, std::size_t size) {
    return (k == 0 ? size : k) - 1;
  }

  // Whether the arc of an edge, between the normals beside it, may hold a
  // direction whose gap exceeds the floor.
  bool ArcMayExceed(const std::vector<double>& gaps, std::size_t k) const {
    return floor_ >= 0 || gaps[k] > floor_ ||
           gaps[Before(k, gaps.size())] > floor_;
  }

  // Whether the arc between two facets' normals may meet the great circle of
  // directions perpendicular to an axis, from the products of the axis with
  // them. Both are zero on a segment, whose arc is a whole circle.
  static bool MayCross(const Polytope& P, double left, double right) {
    const double slack = kRegionSlack * P.radius;
    return (left <= slack && right >= -slack) ||
           (left >= -slack && right <= slack);
  }

  // n is in the region of A's vertex when no neighbor lies farther along −n.
  bool IsInRegionOfA(const Vec3& n) const {
    return IsFarthest(pair_.A, vertex_pair_.a, -n,
                      kRegionSlack * pair_.A.radius);
  }

  // n is in the region of B's vertex when no neighbor lies farther along n.
  bool IsInRegionOfB(const Vec3& n) const {
    return IsFarthest(pair_.B, vertex_pair_.b, pair_.X_AB.R.transpose() * n,
                      kRegionSlack * pair_.B.radius);
  }

  void Append(double h, const Vec3& n, Feature a, Feature b) {
    const NormalConeSupport support =
        rule_ == SurfaceRule::kWholeBoundary
            ? NormalConeSupport::kSupported
            : ClassifySupport(pair_.A, a, n, pair_.B, b,
                              pair_.X_AB.R.transpose() * n);
    workspace_.candidates.push_back({h, n, a, b, support});
    if (support == NormalConeSupport::kSupported) floor_ = h + Tie(pair_);
  }

  const PosedPair& pair_;
  const MinkowskiVertex vertex_pair_;
  const SurfaceRule rule_;
  double floor_;
  DepthWorkspace& workspace_;
  const Fan fan_A_, fan_B_;
  const Vec3 w_;  // the vertex of A ⊖ B, in A's frame
};

}  // namespace

void OverlayGaussRegions(const PosedPair& pair,
                         const MinkowskiVertex& vertex_pair, SurfaceRule rule,
                         double floor, DepthWorkspace* workspace) {
  Overlay(pair, vertex_pair, rule, floor, workspace).Run();
}

}  // namespace drake_haptics
