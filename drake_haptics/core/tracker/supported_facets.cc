#include "tracker/supported_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/normal_cone_support.h"
#include "pair/gauss_overlay.h"

namespace drake_haptics {
namespace {

// Slack of a support test, as a share of the radius: covers what a walk takes
// for a corner of a Gauss region, and round-off.
constexpr double kSlack = 10 * kRegionSlack;

class Listing {
 public:
  Listing(const PosedPair& pair, const MinkowskiVertex& near,
          std::span<const WantedFacets> wanted,
          std::vector<DepthCandidate>* facets)
      : pair_(pair),
        R_BA_(pair.X_AB.R.transpose()),
        of_A_{-pair.A.normal_cone.axis, pair.A.normal_cone.cosine},
        of_B_{pair.X_AB.R * pair.B.normal_cone.axis, pair.B.normal_cone.cosine},
        near_(near),
        center_B_(pair.X_AB * pair.B.centroid),
        near_B_(pair.b(near.b)),
        center_A_(R_BA_ * (pair.A.centroid - pair.X_AB.p)),
        near_A_(R_BA_ * (pair.a(near.a) - pair.X_AB.p)),
        wanted_(wanted),
        facets_(*facets) {
    for (const WantedFacets& some : wanted_) {
      least_ = std::min(least_, some.least);
    }
    facets_.clear();
  }

  void Run() {
    if (!IsAnyInReach()) return;
    AddFacetsOfA();
    AddFacetsOfB();
    if (pair_.A.edges.size() <= pair_.B.edges.size()) {
      AddArcsOfA();
    } else {
      AddArcsOfB();
    }
  }

 private:
  // Whether two cones share a direction.
  static bool DoMeet(const DirectionCone& p, const DirectionCone& q) {
    constexpr double kRoundOff = 1e-12;
    const double a = p.cosine, b = q.cosine;
    return a + b <= 0 ||
           p.axis.dot(q.axis) >=
               a * b - std::sqrt((1 - a * a) * (1 - b * b)) - kRoundOff;
  }

  // Whether both surfaces may carry a contact along a wanted direction.
  bool IsAnyInReach() const {
    if (!DoMeet(of_A_, of_B_)) return false;
    return std::any_of(wanted_.begin(), wanted_.end(), [&](const auto& some) {
      return DoMeet(some.cone, of_A_) && DoMeet(some.cone, of_B_);
    });
  }

  // @param gap upper bound of the gap, m.
  bool IsWanted(const Vec3& n, double gap, double slack = 0) const {
    return gap >= least_ && of_A_.Holds(n, slack) && of_B_.Holds(n, slack) &&
           std::any_of(wanted_.begin(), wanted_.end(), [&](const auto& some) {
             return some.Hold(n, gap, slack);
           });
  }

  // Whether a direction on the arc may be wanted: on an arc of up to 90° each
  // is within 22.5° of an end or the middle. Two pairs of points bound the gap
  // from above; a negative gap is largest at an end of the arc.
  bool MayBeWanted(const Vec3& from, const Vec3& to, const Vec3& between,
                   const Vec3& or_between) const {
    constexpr double kBetween = 0.39;  // 2 sin(π/16)
    if (from.dot(to) < 0) return true;
    const double gap =
        std::min(std::max(from.dot(between), to.dot(between)),
                 std::max(from.dot(or_between), to.dot(or_between)));
    if (gap < least_) return false;
    return IsWanted(from, gap, kBetween) || IsWanted(to, gap, kBetween) ||
           IsWanted((from + to).normalized(), gap, kBetween);
  }

  void AddFacetsOfA() {
    int hint = near_.b;
    for (int f = 0; f < static_cast<int>(pair_.A.facets.size()); ++f) {
      const Polytope::Facet& facet = pair_.A.facets[f];
      if (!facet.original) continue;
      const double gap =
          std::min(facet.normal.dot(center_B_), facet.normal.dot(near_B_)) -
          facet.offset;
      if (!IsWanted(-facet.normal, gap)) continue;
      VisitSupports(pair_.B, R_BA_ * -facet.normal, &hint, [&](int v) {
        Append(-facet.normal, {FeatureKind::kFacet, f},
               {FeatureKind::kVertex, v});
      });
    }
  }

  void AddFacetsOfB() {
    int hint = near_.a;
    for (int f = 0; f < static_cast<int>(pair_.B.facets.size()); ++f) {
      const Polytope::Facet& facet = pair_.B.facets[f];
      if (!facet.original) continue;
      const double gap =
          std::min(facet.normal.dot(center_A_), facet.normal.dot(near_A_)) -
          facet.offset;
      const Vec3 n = pair_.X_AB.R * facet.normal;
      if (!IsWanted(n, gap)) continue;
      VisitSupports(pair_.A, -n, &hint, [&](int v) {
        Append(n, {FeatureKind::kVertex, v}, {FeatureKind::kFacet, f});
      });
    }
  }

  // Calls visit(v) for the farthest vertex and its neighbors that are as far.
  template <typename Visitor>
  static void VisitSupports(const Polytope& P, const Vec3& outward, int* hint,
                            const Visitor& visit) {
    *hint = SupportVertex(P, outward, *hint);
    visit(*hint);
    const double least = -kSlack * P.radius;
    for (const Polytope::OneRingEntry& ring_entry : P.fan_of(*hint)) {
      if (outward.dot(ring_entry.along) >= least) visit(ring_entry.neighbor);
    }
  }

  // The mesh may carry contacts along directions in which the piece reaches
  // farther, beside an edge of its hull.
  static bool IsSupport(const Polytope& P, int v, const Vec3& outward) {
    return IsFarthest(P, v, outward, kSlack * P.radius);
  }

  // Whether two edges are not parallel. The arcs of parallel edges overlap
  // instead of crossing: there is no facet, and no crossing point.
  bool AreCrossed(int edge_A, int edge_B) const {
    const Polytope::Edge& a = pair_.A.edges[edge_A];
    const Polytope::Edge& b = pair_.B.edges[edge_B];
    const Vec3 along_A = pair_.a(a.v1) - pair_.a(a.v0);
    const Vec3 along_B =
        pair_.X_AB.R * (pair_.B.vertices[b.v1] - pair_.B.vertices[b.v0]);
    return along_A.cross(along_B).norm() >
           kParallelSine * along_A.norm() * along_B.norm();
  }

  void AddArcsOfA() {
    int hint = near_.b;
    for (int i = 0; i < static_cast<int>(pair_.A.edges.size()); ++i) {
      const Polytope::Edge& edge = pair_.A.edges[i];
      if (!edge.original) continue;
      const Vec3 from = -edge.normal_arc[0], to = -edge.normal_arc[1];
      if (from.isZero(0) ||
          !MayBeWanted(from, to, pair_.A.vertices[edge.v0] - center_B_,
                       pair_.A.vertices[edge.v0] - near_B_)) {
        continue;
      }
      const auto append = [&](const Vec3& n_B, int j) {
        const Vec3 n = pair_.X_AB.R * n_B;
        if (!AreCrossed(i, j) || !IsSupport(pair_.A, edge.v0, -n)) return;
        Append(n, {FeatureKind::kEdge, i}, {FeatureKind::kEdge, j});
      };
      CrossRegions(pair_.B, R_BA_ * from, R_BA_ * to, &hint, append);
    }
  }

  void AddArcsOfB() {
    int hint = near_.a;
    for (int j = 0; j < static_cast<int>(pair_.B.edges.size()); ++j) {
      const Polytope::Edge& edge = pair_.B.edges[j];
      if (!edge.original) continue;
      if (edge.normal_arc[0].isZero(0)) continue;
      const Vec3 from = pair_.X_AB.R * edge.normal_arc[0];
      const Vec3 to = pair_.X_AB.R * edge.normal_arc[1];
      const Vec3 start = pair_.b(edge.v0);
      if (!MayBeWanted(from, to, pair_.A.centroid - start,
                       pair_.a(near_.a) - start)) {
        continue;
      }
      const auto append = [&](const Vec3& outward_A, int i) {
        if (!AreCrossed(i, j) ||
            !IsSupport(pair_.B, edge.v0, R_BA_ * -outward_A)) {
          return;
        }
        Append(-outward_A, {FeatureKind::kEdge, i}, {FeatureKind::kEdge, j});
      };
      CrossRegions(pair_.A, -from, -to, &hint, append);
    }
  }

  // Follows the support of P along an arc of directions from vertex to vertex
  // and calls cross(direction, edge) for each original edge on the way.
  template <typename Cross>
  static void CrossRegions(const Polytope& P, const Vec3& from, const Vec3& to,
                           int* hint, const Cross& cross) {
    if (from.dot(to) < 0.1) {
      const Vec3 middle = (from.normalized() + to.normalized()).normalized();
      CrossPart(P, from, middle, hint, cross);
      CrossPart(P, middle, to, hint, cross);
      return;
    }
    CrossPart(P, from, to, hint, cross);
  }

  // The same along from + x · side, for x from 0 to 1. No vertex supports two
  // separate parts of it, so there are fewer crossings than vertices.
  template <typename Cross>
  static void CrossPart(const Polytope& P, const Vec3& from, const Vec3& to,
                        int* hint, const Cross& cross) {
    int v = *hint = SupportVertex(P, from, *hint);
    const Vec3 side = to - from;
    double x = 0;
    for (int crossings = 0; crossings < P.num_vertices(); ++crossings) {
      const Polytope::OneRingEntry* next = nullptr;
      double first = 1;
      for (const Polytope::OneRingEntry& ring_entry : P.fan_of(v)) {
        const double rise = side.dot(ring_entry.along);
        if (!(rise > 0)) continue;
        const double at = -from.dot(ring_entry.along);
        if (at <= first * rise) {
          first = at / rise;
          next = &ring_entry;
        }
      }
      if (next == nullptr) return;
      x = std::max(x, first);
      if (next->edge >= 0 && P.edges[next->edge].original) {
        const Vec3 direction = (from + x * side).normalized();
        if (IsSupport(P, v, direction)) cross(direction, next->edge);
      }
      v = next->neighbor;
    }
  }

  void Append(const Vec3& n, Feature a, Feature b) {
    const double h = n.dot(pair_.a(pair_.A.first_vertex_of(a)) -
                           pair_.b(pair_.B.first_vertex_of(b)));
    if (!IsWanted(n, h)) return;
    const NormalConeSupport support =
        ClassifySupport(pair_.A, a, n, pair_.B, b, R_BA_ * n);
    if (support != NormalConeSupport::kSupported) return;
    facets_.push_back({h, n, a, b, support});
  }

  const PosedPair& pair_;
  const Mat3 R_BA_;
  // Directions along which the surfaces can carry contacts.
  const DirectionCone of_A_, of_B_;
  const MinkowskiVertex near_;
  // Points of B in A's frame and of A in B's, which bound gaps from above.
  const Vec3 center_B_, near_B_, center_A_, near_A_;
  const std::span<const WantedFacets> wanted_;
  double least_ = std::numeric_limits<double>::infinity();  // least wanted, m
  std::vector<DepthCandidate>& facets_;
};

}  // namespace

void ListSupportedFacets(const PosedPair& pair, const MinkowskiVertex& near,
                         std::span<const WantedFacets> wanted,
                         std::vector<DepthCandidate>* facets) {
  Listing(pair, near, wanted, facets).Run();
}

}  // namespace drake_haptics
