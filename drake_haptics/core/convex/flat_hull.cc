#include "convex/flat_hull.h"

#include <Eigen/Geometry>
#include <cassert>

#include "convex/convex_polygon.h"

namespace drake_haptics {

bool FlatHull::Contains(const Vec3& point, double tolerance) const {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3& a = corners[k];
    const Vec3 along = corners[(k + 1) % corners.size()] - a;
    if (normal.cross(along).dot(point - a) < -tolerance * along.norm()) {
      return false;
    }
  }
  return true;
}

bool FlatHull::IsFilledBy(double part_area, double tolerance) const {
  constexpr double kRoundOff = 1e-9;
  return part_area >= area * (1 - kRoundOff) - perimeter * tolerance;
}

FlatHull FindFlatHull(std::span<const Vec3> points, const Vec3& normal) {
  assert(!points.empty());
  const Vec3 along = normal.unitOrthogonal();
  const Vec3 across = normal.cross(along);
  std::vector<Eigen::Vector2d> projected;
  projected.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 q = p - points[0];
    projected.emplace_back(along.dot(q), across.dot(q));
  }
  FlatHull hull;
  hull.normal = normal;
  const std::vector<int> loop = ExactConvexPolygon(projected);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Eigen::Vector2d& a = projected[loop[k]];
    const Eigen::Vector2d& b = projected[loop[(k + 1) % loop.size()]];
    hull.area += (a.x() * b.y() - a.y() * b.x()) / 2;
    hull.perimeter += (b - a).norm();
    hull.corners.push_back(points[loop[k]]);
  }
  return hull;
}

}  // namespace drake_haptics
