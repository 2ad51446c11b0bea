#include "mesh/convex_clip.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "convex/polygon_clip.h"

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
  std::vector<Vec3> buffer;
  for (const Plane& plane : planes) {
    const auto depth = [&](const Vec3& p) {
      return -(plane.Height(p) + inset);
    };
    ClipPolygon(depth, &polygon, &buffer);
    if (polygon.empty()) break;
  }
  return polygon;
}

bool MeetsInterior(const std::array<Vec3, 3>& triangle,
                   std::span<const Plane> planes, double inset,
                   std::size_t* likely) {
  const auto is_beyond = [&](const Plane& plane) {
    return std::all_of(triangle.begin(), triangle.end(), [&](const Vec3& p) {
      return plane.Height(p) >= -inset;
    });
  };
  // Most triangles near the body are beyond one of its planes.
  if (*likely < planes.size() && is_beyond(planes[*likely])) return false;
  // Those of a body's newest facets are the last ones, and a triangle that was
  // not in the way of the body before is beyond one of them or near them.
  const auto beyond = std::find_if(planes.rbegin(), planes.rend(), is_beyond);
  if (beyond != planes.rend()) {
    *likely = planes.rend() - beyond - 1;
    return false;
  }
  return !ClipPolygon({triangle.begin(), triangle.end()}, planes, inset)
              .empty();
}

}  // namespace drake_haptics
