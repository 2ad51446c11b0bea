#include "mesh/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/nearest_on_triangle.h"

namespace drake_haptics {
namespace {

constexpr double kExcess = 1.05;
// Negligible distance as a share of the size. Flat areas with different
// triangles are proven to be that near only by parts of that size.
constexpr double kNegligibleShare = 1e-4;

double AngleAt(const Vec3& corner, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - corner, v = b - corner;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double Farthest(const SurfaceDistance& surface, std::span<const Vec3> vertices,
                std::span<const Triangle> triangles) {
  std::vector<std::array<Vec3, 3>> corners;
  AabbTree::Box box;
  for (const Triangle& t : triangles) {
    corners.push_back(CornersOf(vertices, t));
    for (const Vec3& v : corners.back()) box.extend(v);
  }
  return surface.BoundFarthest(corners, std::numeric_limits<double>::infinity(),
                               kNegligibleShare * box.diagonal().norm());
}

}  // namespace

SurfaceDistance::SurfaceDistance(std::span<const Vec3> vertices,
                                 std::span<const Triangle> triangles,
                                 std::span<const std::uint8_t> solid)
    : topology_(vertices, triangles),
      solid_(solid),
      tree_(TriangleBoxes(vertices, triangles)) {
  area_vectors_.reserve(triangles.size());
  for (int t = 0; t < std::ssize(triangles); ++t) {
    const auto [a, b, c] = corners_of(t);
    area_vectors_.push_back((b - a).cross(c - a));
  }
}

SurfaceDistance::Nearest SurfaceDistance::FindNearest(const Vec3& p) const {
  double least = std::numeric_limits<double>::infinity();
  int triangle = -1;
  NearestOnTriangle nearest;
  tree_.VisitNear(p, [&](int t) {
    const NearestOnTriangle found = FindNearestOnTriangle(corners_of(t), p);
    const double squared = (p - found.point).squaredNorm();
    if (squared < least) {
      least = squared;
      triangle = t;
      nearest = found;
    }
    return least;
  });
  double distance = std::sqrt(least);
  if (solid_[triangle] && PseudoNormal(triangle, nearest.kind, nearest.index)
                                  .dot(p - nearest.point) < 0) {
    distance = -distance;
  }
  return {distance, triangle};
}

Vec3 SurfaceDistance::PseudoNormal(int t, FeatureKind kind, int index) const {
  if (kind == FeatureKind::kFacet) return area_vectors_[t];
  const Triangle& triangle = topology_.triangles[t];
  Vec3 sum = Vec3::Zero();
  if (kind == FeatureKind::kEdge) {
    for (const TriangleSide& side :
         topology_.SidesOf(triangle[index], triangle[(index + 1) % 3])) {
      sum += area_vectors_[side.triangle].stableNormalized();
    }
    return sum;
  }
  const int v = triangle[index];
  for (const int other : topology_.triangles_at(v)) {
    const Triangle& around = topology_.triangles[other];
    int k = 0;
    while (around[k] != v) ++k;
    sum +=
        area_vectors_[other].stableNormalized() *
        AngleAt(topology_.vertices[v], topology_.vertices[around[(k + 1) % 3]],
                topology_.vertices[around[(k + 2) % 3]]);
  }
  return sum;
}

// The distance from a convex set is a convex function: on a triangle it is
// largest at a corner.
double SurfaceDistance::FarthestFromTriangle(
    int t, const std::array<Vec3, 3>& from) const {
  const std::array<Vec3, 3> corners = corners_of(t);
  double farthest = 0;
  for (const Vec3& p : from) {
    const Vec3 nearest = FindNearestOnTriangle(corners, p).point;
    farthest = std::max(farthest, (p - nearest).norm());
  }
  return farthest;
}

SurfaceDistance::Part SurfaceDistance::Bound(const std::array<Vec3, 3>& corners,
                                             double enough,
                                             double* largest) const {
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
  const Nearest nearest = FindNearest(middle);
  *largest = std::max(*largest, nearest.distance);
  double radius = 0;
  for (const Vec3& corner : corners) {
    radius = std::max(radius, (corner - middle).norm());
  }
  // The distance changes no faster than the position.
  double bound = std::max(0.0, nearest.distance + radius);
  if (bound > enough) {
    bound = std::min(bound, FarthestFromTriangle(nearest.triangle, corners));
  }
  return {bound, corners};
}

double SurfaceDistance::BoundFarthest(
    std::span<const std::array<Vec3, 3>> triangles, double limit,
    double negligible) const {
  double largest = 0;
  std::vector<Part> open;
  for (const std::array<Vec3, 3>& triangle : triangles) {
    open.push_back(Bound(triangle, negligible, &largest));
    if (largest > limit) return largest;
  }
  // The part with the largest bound is divided first, so that nearer parts stay
  // whole.
  const auto is_lower = [](const Part& a, const Part& b) {
    return a.bound < b.bound;
  };
  std::make_heap(open.begin(), open.end(), is_lower);
  while (!open.empty()) {
    const double enough = std::max(kExcess * largest, negligible);
    if (open.front().bound <= enough) return open.front().bound;
    std::pop_heap(open.begin(), open.end(), is_lower);
    const std::array<Vec3, 3> part = open.back().corners;
    open.pop_back();
    // Cut the longest side, so that slivers become round.
    int longest = 0;
    for (int k = 1; k < 3; ++k) {
      if ((part[(k + 1) % 3] - part[k]).squaredNorm() >
          (part[(longest + 1) % 3] - part[longest]).squaredNorm()) {
        longest = k;
      }
    }
    const Vec3 &a = part[longest], &b = part[(longest + 1) % 3];
    const Vec3 &c = part[(longest + 2) % 3], cut = (a + b) / 2;
    for (const auto& half : {std::array{a, cut, c}, std::array{cut, b, c}}) {
      open.push_back(Bound(half, enough, &largest));
      std::push_heap(open.begin(), open.end(), is_lower);
    }
    if (largest > limit) return largest;
  }
  return 0;
}

double CalcSurfaceDistance(std::span<const Vec3> vertices_A,
                           std::span<const Triangle> triangles_A,
                           std::span<const Vec3> vertices_B,
                           std::span<const Triangle> triangles_B) {
  CheckMesh(vertices_A, triangles_A);
  CheckMesh(vertices_B, triangles_B);
  const std::vector<std::uint8_t> open(
      std::max(triangles_A.size(), triangles_B.size()), 0);
  const SurfaceDistance A(vertices_A, triangles_A, open);
  const SurfaceDistance B(vertices_B, triangles_B, open);
  return std::max(Farthest(A, vertices_B, triangles_B),
                  Farthest(B, vertices_A, triangles_A));
}

}  // namespace drake_haptics
