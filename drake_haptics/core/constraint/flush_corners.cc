#include "constraint/flush_corners.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

namespace drake_haptics {
namespace {

constexpr double kFlushSine = 0.1;
const double kFlushCosine = std::sqrt(1 - kFlushSine * kFlushSine);

// Returns the facet at a vertex that best faces along a unit direction; -1 if
// none is flush with the plane across it.
int FlushFacet(const Polytope& P, int vertex, const Vec3& outward) {
  int best = -1;
  double largest = kFlushCosine;
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(vertex)) {
    const double cosine = ring_entry.normal.dot(outward);
    if (!(cosine > largest)) continue;
    largest = cosine;
    best = ring_entry.facet;
  }
  return best;
}

bool IsFlush(const Vec3& along, const Vec3& n) {
  const double rise = along.dot(n);
  return rise * rise < kFlushSine * kFlushSine * along.squaredNorm();
}

struct Segment {
  Vec3 p, along;

  Vec3 Nearest(const Vec3& point) const {
    const double share = (point - p).dot(along) / along.squaredNorm();
    return p + std::clamp(share, 0.0, 1.0) * along;
  }
};

class Corners {
 public:
  Corners(const PosedPair& pair, const Vec3& n, double reach,
          PatchWorkspace* workspace, std::vector<FacingPoint>* corners)
      : pair_(pair),
        n_(n),
        u_(n.unitOrthogonal()),
        v_(n.cross(u_)),
        reach_(reach),
        workspace_(*workspace),
        corners_(*corners) {}

  void OfFacets(int facet_A, int facet_B) {
    workspace_.polygon.clear();
    for (const int v : pair_.A.loop_of(facet_A)) {
      workspace_.polygon.push_back(ToPlane(pair_.a(v)));
    }
    OnFacetOfB(facet_B);
  }

  void OfEdgeOfA(int edge_A, int facet_B) {
    StartFromSegment(EdgeOfA(edge_A));
    OnFacetOfB(facet_B);
  }

  void OfEdgeOfB(int facet_A, int edge_B) {
    StartFromSegment(EdgeOfB(edge_B));
    ClipByLoop(pair_.A.loop_of(facet_A), -1,
               [this](int v) { return pair_.a(v); });
    const Vec3& normal = pair_.A.facets[facet_A].normal;
    const double offset = pair_.A.facets[facet_A].offset;
    for (const Vec3& corner : workspace_.polygon) {
      const Vec3 p_b = FromPlane(corner);
      const double distance = (offset - normal.dot(p_b)) / normal.dot(n_);
      Add(distance, p_b + distance * n_);
    }
  }

  // Edges that are not quite parallel do not lie above each other, so each end
  // of the overlap is paired with its nearest point.
  void OfEdges(int edge_A, int edge_B) {
    const Segment a = EdgeOfA(edge_A), b = EdgeOfB(edge_B);
    const double sine_squared = a.along.cross(b.along).squaredNorm() /
                                (a.along.squaredNorm() * b.along.squaredNorm());
    if (!(sine_squared < kFlushSine * kFlushSine)) return;
    for (const double share : {0.0, 1.0}) {
      const Vec3 p_b = b.p + share * b.along;
      AddBetween(a.Nearest(p_b), p_b);
      const Vec3 p_a = a.p + share * a.along;
      AddBetween(p_a, b.Nearest(p_a));
    }
  }

 private:
  Vec3 ToPlane(const Vec3& p) const {
    return {u_.dot(p), v_.dot(p), n_.dot(p)};
  }
  Vec3 FromPlane(const Vec3& p) const {
    return p.x() * u_ + p.y() * v_ + p.z() * n_;
  }
  Segment EdgeOfA(int edge) const {
    const Polytope::Edge& e = pair_.A.edges[edge];
    return {pair_.a(e.v0), pair_.a(e.v1) - pair_.a(e.v0)};
  }
  Segment EdgeOfB(int edge) const {
    const Polytope::Edge& e = pair_.B.edges[edge];
    return {pair_.b(e.v0), pair_.b(e.v1) - pair_.b(e.v0)};
  }

  void StartFromSegment(const Segment& segment) {
    workspace_.polygon.clear();
    workspace_.polygon.push_back(ToPlane(segment.p));
    workspace_.polygon.push_back(ToPlane(segment.p + segment.along));
  }

  void OnFacetOfB(int facet_B) {
    ClipByLoop(pair_.B.loop_of(facet_B), 1,
               [this](int v) { return pair_.b(v); });
    const Vec3 normal = pair_.X_AB.R * pair_.B.facets[facet_B].normal;
    const double offset = normal.dot(pair_.b(pair_.B.loop_of(facet_B)[0]));
    for (const Vec3& corner : workspace_.polygon) {
      const Vec3 p_a = FromPlane(corner);
      const double distance = (normal.dot(p_a) - offset) / normal.dot(n_);
      Add(distance, p_a);
    }
  }

  // @param turn 1 for a loop of B, which runs counter-clockwise seen against n,
  //     -1 for one of A.
  template <typename Position>
  void ClipByLoop(std::span<const int> loop, double turn,
                  const Position& position) {
    Vec3 p = ToPlane(position(loop.back()));
    for (const int v : loop) {
      const Vec3 q = ToPlane(position(v)), along = q - p;
      ClipPolygon(
          [&](const Vec3& x) {
            return turn *
                   (along.x() * (x.y() - p.y()) - along.y() * (x.x() - p.x()));
          },
          &workspace_);
      if (workspace_.polygon.empty()) return;
      p = q;
    }
  }

  void Add(double distance, const Vec3& p_a) {
    if (distance <= reach_) corners_.push_back({distance, p_a});
  }
  void AddBetween(const Vec3& p_a, const Vec3& p_b) {
    Add(n_.dot(p_a - p_b), p_a);
  }

  const PosedPair& pair_;
  const Vec3 n_, u_, v_;
  const double reach_;
  PatchWorkspace& workspace_;
  std::vector<FacingPoint>& corners_;
};

template <typename Visitor>
void VisitEdges(const Polytope& P, int vertex, const Vec3& n,
                const Visitor& visit) {
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(vertex)) {
    if (IsFlush(ring_entry.along, n)) visit(ring_entry.edge);
  }
}

}  // namespace

void AppendFlushCorners(const PosedPair& pair, const Vec3& n,
                        const MinkowskiVertex& support, double reach,
                        PatchWorkspace* workspace,
                        std::vector<FacingPoint>* corners) {
  const Vec3 n_B = pair.X_AB.R.transpose() * n;
  const int facet_A = FlushFacet(pair.A, support.a, -n);
  const int facet_B = FlushFacet(pair.B, support.b, n_B);
  Corners found(pair, n, reach, workspace, corners);
  if (facet_A >= 0 && facet_B >= 0) {
    found.OfFacets(facet_A, facet_B);
  } else if (facet_B >= 0) {
    VisitEdges(pair.A, support.a, n,
               [&](int edge) { found.OfEdgeOfA(edge, facet_B); });
  } else if (facet_A >= 0) {
    VisitEdges(pair.B, support.b, n_B,
               [&](int edge) { found.OfEdgeOfB(facet_A, edge); });
  } else {
    VisitEdges(pair.A, support.a, n, [&](int edge_A) {
      VisitEdges(pair.B, support.b, n_B,
                 [&](int edge_B) { found.OfEdges(edge_A, edge_B); });
    });
  }
}

}  // namespace drake_haptics
