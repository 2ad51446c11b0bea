#include "mesh/mesh_coverage.h"

#include <Eigen/Geometry>
#include <utility>

#include "mesh/convex_clip.h"

namespace drake_haptics {
namespace {

// The prism about a polygon: its sides, and the slab of +- tolerance.
std::vector<Plane> Prism(std::span<const Vec3> polygon, const Vec3& normal,
                         double tolerance) {
  const double offset = normal.dot(polygon[0]);
  std::vector<Plane> planes{{normal, offset + tolerance},
                            {-normal, -offset + tolerance}};
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& a = polygon[k];
    const Vec3 along = polygon[(k + 1) % polygon.size()] - a;
    const Vec3 outward = along.cross(normal).stableNormalized();
    planes.push_back({outward, outward.dot(a)});
  }
  return planes;
}

}  // namespace

MeshCoverage::MeshCoverage(std::span<const Vec3> vertices,
                           std::vector<Triangle> triangles)
    : vertices_(vertices),
      triangles_(std::move(triangles)),
      tree_(TriangleBoxes(vertices_, triangles_)) {}

double MeshCoverage::CoveredArea(std::span<const Vec3> polygon,
                                 const Vec3& normal, double tolerance) const {
  const std::vector<Plane> prism = Prism(polygon, normal, tolerance);
  AabbTree::Box box;
  for (const Vec3& corner : polygon) {
    box.extend(corner + Vec3::Constant(tolerance));
    box.extend(corner - Vec3::Constant(tolerance));
  }
  double covered = 0;
  tree_.AnyOverlap(box, [&](int t) {
    const auto [a, b, c] = CornersOf(vertices_, triangles_[t]);
    if ((b - a).cross(c - a).dot(normal) > 0) {
      covered += PolygonArea(ClipPolygon({a, b, c}, prism, 0));
    }
    return false;
  });
  return covered;
}

}  // namespace drake_haptics
