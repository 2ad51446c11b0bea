#include "mesh/nearest_on_triangle.h"

#include <algorithm>
#include <limits>

namespace drake_haptics {

NearestOnTriangle FindNearestOnTriangle(const std::array<Vec3, 3>& corners,
                                        const Vec3& p) {
  const Vec3& a = corners[0];
  const Vec3 normal = (corners[1] - a).cross(corners[2] - a);
  NearestOnTriangle nearest;
  bool is_over = normal.squaredNorm() > 0;
  for (int k = 0; k < 3 && is_over; ++k) {
    const Vec3 along = corners[(k + 1) % 3] - corners[k];
    is_over = normal.cross(along).dot(p - corners[k]) > 0;
  }
  if (is_over) {
    nearest.point = p - normal * (normal.dot(p - a) / normal.squaredNorm());
    return nearest;
  }
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3& from = corners[k];
    const Vec3 along = corners[(k + 1) % 3] - from;
    const double length_squared = along.squaredNorm();
    const double s =
        length_squared > 0 ? along.dot(p - from) / length_squared : 0.0;
    const Vec3 point = from + std::clamp(s, 0.0, 1.0) * along;
    const double squared = (p - point).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    nearest.point = point;
    const bool is_corner = s <= 0 || s >= 1;
    nearest.kind = is_corner ? FeatureKind::kVertex : FeatureKind::kEdge;
    nearest.index = s >= 1 ? (k + 1) % 3 : k;
  }
  return nearest;
}

}  // namespace drake_haptics
