#include "mesh/hull_deviation.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "mesh/convex_clip.h"

namespace drake_haptics {
namespace {

constexpr double kPrecision = 0.05;

std::vector<Plane> FacetPlanes(std::span<const Vec3> points,
                               const HullShape& hull) {
  std::vector<Plane> planes;
  for (const HullShape::Polygon& polygon : hull.polygons) {
    // No corner is above its plane, so that round-off does not bury it.
    double offset = -std::numeric_limits<double>::infinity();
    for (const int v : polygon.loop) {
      offset = std::max(offset, polygon.normal.dot(points[v]));
    }
    planes.push_back({polygon.normal, offset});
  }
  return planes;
}

// Upper bound on the depth of the triangle's deepest point, at least `known`.
double BoundDepth(const std::array<Vec3, 3>& triangle,
                  std::span<const Plane> planes, double known) {
  double bound = std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes) {
    double deepest = known;
    for (const Vec3& corner : triangle) {
      deepest = std::max(deepest, -plane.Height(corner));
    }
    bound = std::min(bound, deepest);
    if (bound <= known) return known;
  }
  const std::vector<Vec3> corners(triangle.begin(), triangle.end());
  if (ClipPolygon(corners, planes, known).empty()) return known;
  while (bound - known > kPrecision * bound) {
    const double middle = (known + bound) / 2;
    (ClipPolygon(corners, planes, middle).empty() ? bound : known) = middle;
  }
  return bound;
}

// Upper bound on the depth of the surface in a solid hull, m.
double BoundBuried(std::span<const Vec3> points, const HullShape& hull,
                   const SurfaceDistance& surface, double limit,
                   double negligible) {
  const std::vector<Plane> planes = FacetPlanes(points, hull);
  AabbTree::Box box;
  for (const int v : hull.extreme) box.extend(points[v]);
  double bound = negligible;
  surface.tree().AnyOverlap(box, [&](int t) {
    bound = BoundDepth(surface.corners_of(t), planes, bound);
    return bound > limit;
  });
  return bound > negligible ? bound : 0;
}

}  // namespace

double BoundDeparture(std::span<const Vec3> points, const HullShape& hull,
                      const SurfaceDistance& surface, double limit,
                      double negligible) {
  Vec3 middle = Vec3::Zero();
  for (const int v : hull.extreme) middle += points[v];
  middle /= static_cast<double>(hull.extreme.size());
  double bound = surface.FindNearest(middle).distance;
  if (bound > limit) return bound;
  if (hull.dimension == 3) {
    bound =
        std::max(bound, BoundBuried(points, hull, surface, limit, negligible));
    if (bound > limit) return bound;
  }
  std::vector<std::array<Vec3, 3>> boundary;
  for (const HullShape::Polygon& polygon : hull.polygons) {
    const std::vector<int>& loop = polygon.loop;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      boundary.push_back(
          {points[loop[0]], points[loop[k]], points[loop[k + 1]]});
    }
    if (hull.dimension == 2) break;  // the back is where the front is
  }
  return std::max(bound, surface.BoundFarthest(boundary, limit, negligible));
}

}  // namespace drake_haptics
