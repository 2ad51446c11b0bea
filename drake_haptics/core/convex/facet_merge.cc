#include "convex/facet_merge.h"

#include <algorithm>
#include <numeric>

namespace drake_haptics {
namespace {

using Polygon = HullShape::Polygon;

struct TriangleEdge {
  int triangle = -1, edge = -1;
  bool operator==(const TriangleEdge&) const = default;
};

// Whether the loops are polygons that form one closed surface without handles.
bool IsSphere(const std::vector<Polygon>& polygons) {
  std::vector<std::pair<int, int>> forward, backward;
  std::vector<int> used;
  for (const Polygon& polygon : polygons) {
    const std::vector<int>& loop = polygon.loop;
    if (loop.size() < 3) return false;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int a = loop[k], b = loop[(k + 1) % loop.size()];
      forward.emplace_back(a, b);
      backward.emplace_back(b, a);
      used.push_back(a);
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  std::sort(used.begin(), used.end());
  const auto num_used = std::unique(used.begin(), used.end()) - used.begin();
  const bool simple =
      std::adjacent_find(forward.begin(), forward.end()) == forward.end();
  return simple && forward == backward &&
         2 * (num_used + std::ssize(polygons) - 2) == std::ssize(forward);
}

class Merger {
 public:
  Merger(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
         std::span<const std::uint8_t> on_surface)
      : points_(points),
        triangles_(triangles),
        on_surface_(on_surface),
        group_(triangles.size(), -1),
        runs_(points.size(), 0) {}

  // Floods from the largest triangles. All are compared with the seed's plane,
  // so that a gently curved surface does not become one facet.
  void Group(double tolerance) {
    std::vector<int> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
      return triangles_[i].area > triangles_[j].area;
    });
    for (const int seed : order) {
      if (group_[seed] < 0) Flood(seed, tolerance);
    }
  }

  // A point of three facets or more is extreme; a point of two lies on a
  // straight edge, a point of one inside that facet.
  void CountRunsAroundPoints() {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int neighbor = triangles_[t].neighbor[k];
        runs_[triangles_[t].vertex[k]] += group_[neighbor] != group_[t];
      }
    }
  }

  // Returns the polygons, or none if they do not form a closed surface.
  std::vector<Polygon> Collect() const {
    std::vector<int> num_boundary_edges(seeds_.size(), 0);
    std::vector<TriangleEdge> start(seeds_.size());
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
      for (int k = 0; k < 3; ++k) {
        if (!OnBoundary({t, k})) continue;
        if (num_boundary_edges[group_[t]]++ == 0) start[group_[t]] = {t, k};
      }
    }
    std::vector<Polygon> polygons;
    for (std::size_t g = 0; g < seeds_.size(); ++g) {
      const int seed = seeds_[g];
      polygons.push_back({triangles_[seed].normal, {}, on_surface_[seed] != 0});
      // Further cycles would be holes.
      if (TraceBoundary(start[g], &polygons[g].loop) != num_boundary_edges[g]) {
        return {};
      }
    }
    return IsSphere(polygons) ? polygons : std::vector<Polygon>{};
  }

  std::vector<Polygon> Unmerged() const {
    std::vector<Polygon> polygons;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& v = triangles_[t].vertex;
      polygons.push_back(
          {triangles_[t].normal, {v[0], v[1], v[2]}, on_surface_[t] != 0});
    }
    return polygons;
  }

 private:
  void Flood(int seed, double tolerance) {
    const int group = static_cast<int>(seeds_.size());
    seeds_.push_back(seed);
    group_[seed] = group;
    const Vec3& normal = triangles_[seed].normal;
    const Vec3& base = points_[triangles_[seed].vertex[0]];
    std::vector<int> stack{seed};
    while (!stack.empty()) {
      const int t = stack.back();
      stack.pop_back();
      for (const int next : triangles_[t].neighbor) {
        if (group_[next] >= 0 || triangles_[next].normal.dot(normal) <= 0)
          continue;
        if (on_surface_[next] != on_surface_[seed] &&
            !IsThin(triangles_[next], tolerance)) {
          continue;
        }
        const auto& v = triangles_[next].vertex;
        if (std::all_of(v.begin(), v.end(), [&](int i) {
              return std::abs(normal.dot(points_[i] - base)) <= tolerance;
            })) {
          group_[next] = group;
          stack.push_back(next);
        }
      }
    }
  }

  bool IsThin(const HullTriangle& triangle, double tolerance) const {
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (points_[triangle.vertex[(k + 1) % 3]] -
                                   points_[triangle.vertex[k]])
                                      .norm());
    }
    return 2 * triangle.area <= tolerance * longest;
  }

  bool OnBoundary(const TriangleEdge& e) const {
    return group_[triangles_[e.triangle].neighbor[e.edge]] !=
           group_[e.triangle];
  }

  // The next boundary edge of the same group, around the end of `e`.
  TriangleEdge NextOnBoundary(TriangleEdge e) const {
    const int pivot = triangles_[e.triangle].vertex[(e.edge + 1) % 3];
    e.edge = (e.edge + 1) % 3;
    while (!OnBoundary(e)) {
      e.triangle = triangles_[e.triangle].neighbor[e.edge];
      const auto& v = triangles_[e.triangle].vertex;
      e.edge =
          static_cast<int>(std::find(v.begin(), v.end(), pivot) - v.begin());
    }
    return e;
  }

  // Collects the extreme points of one boundary cycle; returns its length.
  int TraceBoundary(const TriangleEdge& start, std::vector<int>* loop) const {
    int length = 0;
    TriangleEdge e = start;
    do {
      const int from = triangles_[e.triangle].vertex[e.edge];
      if (runs_[from] >= 3) loop->push_back(from);
      e = NextOnBoundary(e);
      ++length;
    } while (e != start);
    return length;
  }

  std::span<const Vec3> points_;
  std::span<const HullTriangle> triangles_;
  std::span<const std::uint8_t> on_surface_;
  std::vector<int> group_;
  std::vector<int> seeds_;
  std::vector<int> runs_;
};

}  // namespace

std::vector<Polygon> MergeCoplanar(std::span<const Vec3> points,
                                   std::span<const HullTriangle> triangles,
                                   std::span<const std::uint8_t> on_surface,
                                   double tolerance) {
  Merger merger(points, triangles, on_surface);
  merger.Group(tolerance);
  merger.CountRunsAroundPoints();
  std::vector<Polygon> polygons = merger.Collect();
  return polygons.empty() ? merger.Unmerged() : polygons;
}

}  // namespace drake_haptics
