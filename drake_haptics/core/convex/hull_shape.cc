#include "convex/hull_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "base/sort_unique.h"
#include "convex/affine_basis.h"
#include "convex/convex_hull.h"
#include "convex/convex_polygon.h"
#include "convex/facet_merge.h"
#include "convex/predicates.h"
#include "convex/weld_points.h"

namespace drake_haptics {
namespace {

// Points closer than this share of the size are one. It is a hundred times the
// flatness that merges facets, so that merging keeps the edge between two
// points.
constexpr double kSamePointShare = 1e-10;

// Drops corners within the tolerance of the line through their neighbors. Two
// neighbors are never dropped in the same pass, so that a fine polygon cannot
// vanish.
void DropStraightCorners(std::span<const Vec3> points, double tolerance,
                         std::vector<int>* loop) {
  bool dropped = true;
  while (dropped && loop->size() > 2) {
    dropped = false;
    std::vector<int> kept;
    for (std::size_t k = 0; k < loop->size(); ++k) {
      const Vec3& before = points[kept.empty() ? loop->back() : kept.back()];
      const Vec3& after = points[(*loop)[(k + 1) % loop->size()]];
      const Vec3 chord = after - before;
      const double deviation =
          chord.cross(points[(*loop)[k]] - before).norm() /
          std::max(chord.norm(), std::numeric_limits<double>::min());
      // Both neighbors are still there in this pass.
      const bool may_drop =
          (k == 0 || (!kept.empty() && kept.back() == (*loop)[k - 1])) &&
          (k + 1 < loop->size() ||
           (!kept.empty() && kept.front() == loop->front()));
      if (may_drop && deviation <= tolerance) {
        dropped = true;
      } else {
        kept.push_back((*loop)[k]);
      }
    }
    *loop = std::move(kept);
  }
}

std::vector<int> FlatLoop(std::span<const Vec3> points, const Vec3& normal,
                          const Vec3& along, double tolerance) {
  const Vec3 across = normal.cross(along);
  std::vector<Eigen::Vector2d> projected;
  projected.reserve(points.size());
  for (const Vec3& p : points) {
    projected.emplace_back(along.dot(p), across.dot(p));
  }
  std::vector<int> loop = ExactConvexPolygon(projected);
  DropStraightCorners(points, tolerance, &loop);
  return loop;
}

std::vector<HullShape::Polygon> Polygons(std::span<const Vec3> points,
                                         const AffineBasis& basis,
                                         double tolerance,
                                         const SurfaceTest& is_on_surface) {
  const auto& p = basis.point;
  if (basis.dimension == 3) {
    const std::vector<HullTriangle> triangles =
        ConvexHull(points, p).Triangles();
    std::vector<std::uint8_t> on_surface(triangles.size(), 1);
    for (std::size_t t = 0; is_on_surface && t < triangles.size(); ++t) {
      on_surface[t] = is_on_surface(triangles[t].vertex, triangles[t].normal);
    }
    return MergeCoplanar(points, triangles, on_surface, tolerance);
  }
  const Vec3 normal =
      TriangleCross(points[p[0]], points[p[1]], points[p[2]]).normalized();
  const Vec3 along = (points[p[1]] - points[p[0]]).normalized();
  const std::vector<int> loop = FlatLoop(points, normal, along, tolerance);
  std::vector<int> back = loop;
  std::reverse(back.begin() + 1, back.end());
  return {{normal, loop}, {-normal, back}};
}

std::vector<int> ExtremePoints(const AffineBasis& basis,
                               std::span<const HullShape::Polygon> polygons) {
  std::vector<int> extreme(basis.point.begin(),
                           basis.point.begin() + basis.dimension + 1);
  if (!polygons.empty()) extreme.clear();
  for (const HullShape::Polygon& polygon : polygons) {
    extreme.insert(extreme.end(), polygon.loop.begin(), polygon.loop.end());
  }
  SortUnique(&extreme);
  return extreme;
}

}  // namespace

bool AreUsable(std::span<const Vec3> points) {
  // Beyond this, squares of areas overflow.
  static constexpr double kLargest = 1e50;
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) {
    return (p.array().abs() < kLargest).all();  // False for NaN.
  });
}

HullShape FindHullShape(std::span<const Vec3> points, double tolerance,
                        const SurfaceTest& is_on_surface) {
  double magnitude = 0;
  for (const Vec3& p : points) {
    magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  }
  const double scale = PowerOfTwoScale(magnitude);
  std::vector<Vec3> normalized;
  normalized.reserve(points.size());
  for (const Vec3& p : points) {
    normalized.push_back(NormalizeForPredicates(p, scale));
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& p : normalized) box.extend(p);
  const std::vector<int> source =
      WeldPoints(normalized, kSamePointShare * box.diagonal().norm());
  std::vector<Vec3> distinct;
  distinct.reserve(source.size());
  for (const int i : source) distinct.push_back(normalized[i]);

  // The coordinates are below 1 now, and their round-off below epsilon.
  const double thickness =
      std::max(tolerance * scale, 4 * std::numeric_limits<double>::epsilon());
  const AffineBasis basis = FindAffineBasis(distinct, thickness);
  HullShape shape;
  shape.dimension = basis.dimension;
  if (basis.dimension >= 2) {
    const auto is_on_surface_by_source = [&](const std::array<int, 3>& points,
                                             const Vec3& normal) {
      return is_on_surface(
          {source[points[0]], source[points[1]], source[points[2]]}, normal);
    };
    shape.polygons = Polygons(
        distinct, basis, thickness,
        is_on_surface ? SurfaceTest(is_on_surface_by_source) : SurfaceTest());
  }
  shape.extreme = ExtremePoints(basis, shape.polygons);
  for (int& i : shape.extreme) i = source[i];
  for (HullShape::Polygon& polygon : shape.polygons) {
    for (int& i : polygon.loop) i = source[i];
  }
  return shape;
}

}  // namespace drake_haptics
