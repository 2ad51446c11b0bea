#include "contact_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace drake_haptics {
namespace {

// Sines of the tilt up to which a facet is flush, and from which it is not any
// more. Two edges of a right-angled corner at kFlush make a facet at kTilted,
// so that a facet takes over before two edges share the contact.
constexpr double kFlush = 0.05;
constexpr double kTilted = 0.0707;
// A little below the cosine of the latter.
constexpr double kCosTilted = 0.9974;

double FacetShare(double sine) {
  return std::clamp((kTilted - sine) / (kTilted - kFlush), 0.0, 1.0);
}

double EdgeShare(double sine) {
  return std::max(0.0, 1 - sine * sine / (kFlush * kFlush));
}

// The facet at a vertex that lies most flush with the contact's plane.
struct FlushFacet {
  int index = -1;
  double share = 0;
};

FlushFacet FindFlushFacet(const Polytope& P, int vertex, const Vec3& outward) {
  FlushFacet found;
  double least = kTilted;
  for (const Polytope::Spoke& spoke : P.fan_of(vertex)) {
    if (!(spoke.normal.dot(outward) > kCosTilted)) continue;
    const double sine = spoke.normal.cross(outward).norm();
    if (sine < least) {
      least = sine;
      found = {spoke.facet, FacetShare(sine)};
    }
  }
  return found;
}

// Calls visit(edge, share) for each edge at a vertex that lies flush.
template <typename Visitor>
void VisitFlushEdges(const Polytope& P, int vertex, const Vec3& outward,
                     const Visitor& visit) {
  for (const Polytope::Spoke& spoke : P.fan_of(vertex)) {
    const double rise = spoke.along.dot(outward);
    const double length_squared = spoke.along.squaredNorm();
    if (rise * rise < kFlush * kFlush * length_squared) {
      visit(spoke.edge, EdgeShare(std::abs(rise) / std::sqrt(length_squared)));
    }
  }
}

// The contact's plane: coordinates along u and v, height along n.
struct Plane {
  Vec3 u, v, n;

  explicit Plane(const Vec3& normal) : n(normal) {
    u = n.unitOrthogonal();
    v = n.cross(u);
  }
  Vec3 To(const Vec3& p) const { return {u.dot(p), v.dot(p), n.dot(p)}; }
};

// Height of a facet's plane above the contact's plane, as a linear function.
struct Height {
  double x = 0, y = 0, constant = 0;

  Height(const Vec3& normal, const Vec3& point) {
    x = -normal.x() / normal.z();
    y = -normal.y() / normal.z();
    constant = point.z() - x * point.x() - y * point.y();
  }
  double operator()(const Vec3& p) const {
    return x * p.x() + y * p.y() + constant;
  }
};

// Keeps the part of a convex polygon, or of a segment given as two corners,
// where the linear function with the given corner values is not negative.
template <typename Value>
void Clip(const Value& value, PatchWorkspace* workspace) {
  const std::vector<Vec3>& polygon = workspace->polygon;
  std::vector<Vec3>& clipped = workspace->clipped;
  clipped.clear();
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = polygon[i];
    const double at_p = value(p);
    if (at_p >= 0) clipped.push_back(p);
    if (count == 2 && i == 1) break;  // A segment does not close.
    const Vec3& q = polygon[(i + 1) % count];
    const double at_q = value(q);
    if ((at_p < 0) != (at_q < 0) && at_p != at_q) {
      clipped.push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
  }
  workspace->polygon.swap(clipped);
}

// Centre of the linear pressure (z of the corners) over a polygon or segment.
std::optional<Vec3> Center(const std::vector<Vec3>& corners) {
  double total = 0;
  Vec3 moment = Vec3::Zero();
  if (corners.size() == 2) {
    const Vec3 &p = corners[0], &q = corners[1];
    total = p.z() + q.z();
    moment = (p * (2 * p.z() + q.z()) + q * (p.z() + 2 * q.z())) / 3;
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3 &p = corners[0], &q = corners[i], &r = corners[i + 1];
    const double area =
        std::abs((q - p).x() * (r - p).y() - (q - p).y() * (r - p).x());
    const double sum = p.z() + q.z() + r.z();
    total += area * sum / 3;
    moment +=
        area / 12 * (p * (sum + p.z()) + q * (sum + q.z()) + r * (sum + r.z()));
  }
  if (!(total > 0)) return std::nullopt;
  return Vec3(moment / total);
}

class Patch {
 public:
  Patch(const PosedPair& pair, const Vec3& n, double h, double spread,
        PatchWorkspace* workspace)
      : pair_(pair),
        plane_(n),
        h_(h),
        spread_(spread),
        workspace_(*workspace) {}

  std::optional<Vec3> OfFacets(int facet_A, int facet_B) {
    workspace_.polygon.clear();
    for (const int v : pair_.A.loop_of(facet_A)) {
      workspace_.polygon.push_back(plane_.To(pair_.a(v)));
    }
    const Height of_A(plane_.To(pair_.A.facets[facet_A].normal),
                      workspace_.polygon[0]);
    return Finish(of_A, CutByFacetOfB(facet_B));
  }

  std::optional<Vec3> OfEdgeOfA(int edge_A, int facet_B) {
    const Polytope::Edge& edge = pair_.A.edges[edge_A];
    const Height of_A = StartFromSegment(pair_.a(edge.v0), pair_.a(edge.v1));
    return Finish(of_A, CutByFacetOfB(facet_B));
  }

  std::optional<Vec3> OfEdgeOfB(int facet_A, int edge_B) {
    const Polytope::Edge& edge = pair_.B.edges[edge_B];
    const Height of_B = StartFromSegment(pair_.b(edge.v0), pair_.b(edge.v1));
    return Finish(CutByFacetOfA(facet_A), of_B);
  }

 private:
  Height CutByFacetOfA(int facet) {
    return Cut(
        pair_.A, facet, [this](int v) { return pair_.a(v); },
        pair_.A.facets[facet].normal);
  }

  Height CutByFacetOfB(int facet) {
    return Cut(
        pair_.B, facet, [this](int v) { return pair_.b(v); },
        pair_.X_AB.R * pair_.B.facets[facet].normal);
  }

  std::optional<Vec3> Finish(const Height& of_A, const Height& of_B) {
    for (Vec3& corner : workspace_.polygon) {
      corner.z() = spread_ + h_ - (of_A(corner) - of_B(corner));
    }
    Clip([](const Vec3& p) { return p.z(); }, &workspace_);
    const auto center = Center(workspace_.polygon);
    if (!center) return std::nullopt;
    return Vec3(plane_.u * center->x() + plane_.v * center->y());
  }

  // The height of a segment is taken constant across it.
  Height StartFromSegment(const Vec3& p, const Vec3& q) {
    workspace_.polygon.clear();
    workspace_.polygon.push_back(plane_.To(p));
    workspace_.polygon.push_back(plane_.To(q));
    const Vec3 along = workspace_.polygon[1] - workspace_.polygon[0];
    const Vec3 across = along.cross(Vec3::UnitZ());
    return Height(across.cross(along), workspace_.polygon[0]);
  }

  template <typename Position>
  Height Cut(const Polytope& P, int facet, const Position& position,
             const Vec3& normal_A) {
    const auto loop = P.loop_of(facet);
    const Vec3 normal = plane_.To(normal_A);
    const Vec3 first = plane_.To(position(loop[0]));
    // Seen along n, A's loops run clockwise and B's counter-clockwise.
    const double turn = normal.z() > 0 ? 1.0 : -1.0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3 p = plane_.To(position(loop[k]));
      const Vec3 along = plane_.To(position(loop[(k + 1) % loop.size()])) - p;
      Clip(
          [&](const Vec3& x) {
            return turn *
                   (along.x() * (x.y() - p.y()) - along.y() * (x.x() - p.x()));
          },
          &workspace_);
      if (workspace_.polygon.empty()) break;
    }
    return Height(normal, first);
  }

  const PosedPair& pair_;
  const Plane plane_;
  const double h_, spread_;
  PatchWorkspace& workspace_;
};

// Weighted mean of the centres of all features that share the contact.
struct Blend {
  double total = 0, rest = 1;
  Vec3 sum = Vec3::Zero();

  void Add(const std::optional<Vec3>& center, double share) {
    if (!center) return;
    total += share;
    rest *= 1 - share;
    sum += share * *center;
  }
};

// How many edges at a vertex fall away from the plane by less than the layer.
int CountFlushEdges(const Polytope& P, int vertex, const Vec3& outward,
                    double layer) {
  const auto fan = P.fan_of(vertex);
  return static_cast<int>(std::count_if(
      fan.begin(), fan.end(),
      [&](const auto& spoke) { return outward.dot(spoke.along) >= -layer; }));
}

}  // namespace

bool MayHaveExtent(const PosedPair& pair, const Vec3& n, const Hub& hub,
                   double layer) {
  const int of_A = CountFlushEdges(pair.A, hub.a, -n, layer);
  if (of_A == 0) return false;
  const Vec3 n_B = pair.X_AB.R.transpose() * n;
  const int of_B = CountFlushEdges(pair.B, hub.b, n_B, layer);
  return of_B > 0 && of_A + of_B > 2;
}

std::optional<Vec3> PressureCenter(const PosedPair& pair, const Vec3& n,
                                   double h, const Hub& hub,
                                   const Vec3& witness, double spread,
                                   PatchWorkspace* workspace) {
  const Vec3 n_B = pair.X_AB.R.transpose() * n;
  const FlushFacet a = FindFlushFacet(pair.A, hub.a, -n);
  const FlushFacet b = FindFlushFacet(pair.B, hub.b, n_B);
  if (a.index < 0 && b.index < 0) return std::nullopt;
  Patch patch(pair, n, h, spread, workspace);
  Blend blend;
  if (a.index >= 0 && b.index >= 0) {
    blend.Add(patch.OfFacets(a.index, b.index), a.share * b.share);
  }
  if (b.index >= 0 && a.share < 1) {
    VisitFlushEdges(pair.A, hub.a, n, [&](int edge, double share) {
      blend.Add(patch.OfEdgeOfA(edge, b.index),
                share * b.share * (1 - a.share));
    });
  }
  if (a.index >= 0 && b.share < 1) {
    VisitFlushEdges(pair.B, hub.b, n_B, [&](int edge, double share) {
      blend.Add(patch.OfEdgeOfB(a.index, edge),
                share * a.share * (1 - b.share));
    });
  }
  if (!(blend.total > 0)) return std::nullopt;
  const Vec3 flat = witness - n * n.dot(witness);
  const Vec3 center =
      (blend.sum + blend.rest * flat) / (blend.total + blend.rest);
  return Vec3(center + n * n.dot(witness));
}

}  // namespace drake_haptics
