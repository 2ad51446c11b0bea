#include "contact_patch.h"

#include <Eigen/Geometry>
#include <cmath>

namespace drake_haptics {
namespace {

// Sine of the tilt beyond which a feature is not flush: the layer's pressure
// has shrunk to its corner by then.
constexpr double kFlushSine = 0.17;

// A facet or edge that lies nearly flush with the contact's plane.
struct FlushFeature {
  FeatureKind kind = FeatureKind::kVertex;
  int index = -1;
};

FlushFeature FindFlush(const Polytope& P, int vertex, const Vec3& outward) {
  FlushFeature found;
  double best = std::sqrt(1 - kFlushSine * kFlushSine);
  for (const int facet : P.facets_of(vertex)) {
    const double cosine = P.facets[facet].normal.dot(outward);
    if (cosine > best) {
      best = cosine;
      found = {FeatureKind::kFacet, facet};
    }
  }
  if (found.index >= 0) return found;
  double least = kFlushSine;
  const auto neighbors = P.neighbors_of(vertex);
  for (std::size_t i = 0; i < neighbors.size(); ++i) {
    const Vec3 along = P.vertices[neighbors[i]] - P.vertices[vertex];
    const double sine = std::abs(along.dot(outward)) / along.norm();
    if (sine < least) {
      least = sine;
      found = {FeatureKind::kEdge, P.neighbor_edges_of(vertex)[i]};
    }
  }
  return found;
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
  Patch(const PosedPair& pair, const Vec3& n, PatchWorkspace* workspace)
      : pair_(pair), plane_(n), workspace_(*workspace) {}

  // Starts with the corners of A's feature, in the plane.
  Height StartFromA(const FlushFeature& feature) {
    workspace_.polygon.clear();
    if (feature.kind == FeatureKind::kFacet) {
      for (const int v : pair_.A.loop_of(feature.index)) {
        workspace_.polygon.push_back(plane_.To(pair_.a(v)));
      }
      return Height(plane_.To(pair_.A.facets[feature.index].normal),
                    workspace_.polygon[0]);
    }
    const Polytope::Edge& edge = pair_.A.edges[feature.index];
    return StartFromSegment(pair_.a(edge.v0), pair_.a(edge.v1));
  }

  // The same with an edge of B, to be cut by A's facet.
  Height StartFromB(const FlushFeature& feature) {
    workspace_.polygon.clear();
    const Polytope::Edge& edge = pair_.B.edges[feature.index];
    return StartFromSegment(pair_.b(edge.v0), pair_.b(edge.v1));
  }

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

  std::optional<Vec3> Finish(const Height& of_A, const Height& of_B, double h,
                             double spread) {
    for (Vec3& corner : workspace_.polygon) {
      corner.z() = spread + h - (of_A(corner) - of_B(corner));
    }
    Clip([](const Vec3& p) { return p.z(); }, &workspace_);
    const auto center = Center(workspace_.polygon);
    if (!center) return std::nullopt;
    return Vec3(plane_.u * center->x() + plane_.v * center->y());
  }

 private:
  // The height of a segment is taken constant across it.
  Height StartFromSegment(const Vec3& p, const Vec3& q) {
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
  PatchWorkspace& workspace_;
};

}  // namespace

std::optional<Vec3> PressureCenter(const PosedPair& pair, const Vec3& n,
                                   double h, const Hub& hub, double spread,
                                   PatchWorkspace* workspace) {
  const FlushFeature a = FindFlush(pair.A, hub.a, -n);
  const FlushFeature b = FindFlush(pair.B, hub.b, pair.X_AB.R.transpose() * n);
  Patch patch(pair, n, workspace);
  if (b.kind == FeatureKind::kFacet && a.index >= 0) {
    const Height of_A = patch.StartFromA(a);
    return patch.Finish(of_A, patch.CutByFacetOfB(b.index), h, spread);
  }
  if (a.kind == FeatureKind::kFacet && b.index >= 0) {
    const Height of_B = patch.StartFromB(b);
    return patch.Finish(patch.CutByFacetOfA(a.index), of_B, h, spread);
  }
  return std::nullopt;
}

}  // namespace drake_haptics
