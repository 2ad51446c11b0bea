#include "convex/affine_basis.h"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>
#include <utility>

#include "convex/predicates.h"

namespace drake_haptics {
namespace {

template <typename Measure>
std::pair<int, double> Farthest(std::span<const Vec3> points,
                                const Measure& measure) {
  int best = 0;
  double most = measure(points[0]);
  for (int i = 1; i < static_cast<int>(points.size()); ++i) {
    const double value = measure(points[i]);
    if (value > most) {
      most = value;
      best = i;
    }
  }
  return {best, most};
}

}  // namespace

AffineBasis FindAffineBasis(std::span<const Vec3> points, double tolerance) {
  assert(!points.empty());
  AffineBasis result;
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  int axis = 0;
  if ((high - low).maxCoeff(&axis) <= tolerance) return result;
  auto& p = result.point;
  p[0] = Farthest(points, [&](const Vec3& q) { return -q[axis]; }).first;
  p[1] = Farthest(points, [&](const Vec3& q) { return q[axis]; }).first;
  result.dimension = 1;

  const Vec3 base = points[p[0]];
  const Vec3 along = (points[p[1]] - base).normalized();
  const auto [third, width] = Farthest(
      points, [&](const Vec3& q) { return (q - base).cross(along).norm(); });
  if (width <= tolerance) return result;
  p[2] = third;
  result.dimension = 2;

  const Vec3 normal =
      TriangleCross(base, points[p[1]], points[p[2]]).normalized();
  const auto [fourth, height] = Farthest(
      points, [&](const Vec3& q) { return std::abs(normal.dot(q - base)); });
  if (height <= tolerance ||
      Orient3d(base, points[p[1]], points[p[2]], points[fourth]) == 0) {
    return result;
  }
  p[3] = fourth;
  result.dimension = 3;
  return result;
}

}  // namespace drake_haptics
