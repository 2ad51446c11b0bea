#include "pair/triangle_nearest.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drake_haptics {
namespace {

// The point of a segment that is nearest to the origin.
Vec3 SegmentNearest(const Vec3& p, const Vec3& q) {
  const Vec3 along = q - p;
  const double s = -p.dot(along), length_squared = along.squaredNorm();
  if (!(s > 0)) return p;
  if (!(s < length_squared)) return q;
  return p + (s / length_squared) * along;
}

}  // namespace

TriangleNearest FindTriangleNearest(const Vec3& p, const Vec3& q,
                                    const Vec3& r) {
  const Vec3 normal = (q - p).cross(r - p);
  const double sides[3] = {normal.dot(p.cross(q)), normal.dot(q.cross(r)),
                           normal.dot(r.cross(p))};
  if (sides[0] > 0 && sides[1] > 0 && sides[2] > 0) {
    const double turn = normal.dot(p) < 0 ? -1.0 : 1.0;
    const Vec3 n = normal * (turn / normal.norm());
    return {n, std::max(0.0, std::min({n.dot(p), n.dot(q), n.dot(r)}))};
  }
  // Beyond one or two sides: the nearest point is on one of them.
  const Vec3* corners[4] = {&p, &q, &r, &p};
  Vec3 nearest = p;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (sides[k] > 0) continue;
    const Vec3 point = SegmentNearest(*corners[k], *corners[k + 1]);
    const double squared = point.squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = point;
    }
  }
  const double distance = std::sqrt(least);
  if (!(distance > 0)) return {};
  return {nearest / distance, distance};
}

}  // namespace drake_haptics
