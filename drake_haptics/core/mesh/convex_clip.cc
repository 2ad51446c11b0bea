#include "mesh/convex_clip.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace drake_haptics {

double PolygonArea(std::span<const Vec3> polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    sum += (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0]);
  }
  return sum.norm() / 2;
}

std::vector<Vec3> ClipPolygon(std::vector<Vec3> polygon,
                              std::span<const Plane> planes, double inset) {
  std::vector<Vec3> kept;
  for (const Plane& plane : planes) {
    kept.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3& a = polygon[k];
      const Vec3& b = polygon[(k + 1) % polygon.size()];
      const double height_a = plane.Height(a) + inset;
      const double height_b = plane.Height(b) + inset;
      if (height_a <= 0) kept.push_back(a);
      if ((height_a < 0 && height_b > 0) || (height_a > 0 && height_b < 0)) {
        kept.push_back(a + (b - a) * (height_a / (height_a - height_b)));
      }
    }
    polygon.swap(kept);
    if (polygon.empty()) break;
  }
  return polygon;
}

bool MeetsInterior(const std::array<Vec3, 3>& triangle,
                   std::span<const Plane> planes, double inset) {
  // Most neighbors of the body are beyond one of its planes.
  for (const Plane& plane : planes) {
    if (std::all_of(triangle.begin(), triangle.end(),
                    [&](const Vec3& p) { return plane.Height(p) >= -inset; })) {
      return false;
    }
  }
  return !ClipPolygon({triangle.begin(), triangle.end()}, planes, inset)
              .empty();
}

}  // namespace drake_haptics
