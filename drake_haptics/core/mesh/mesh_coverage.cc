#include "mesh/mesh_coverage.h"

#include <Eigen/Geometry>

#include "mesh/convex_clip.h"

namespace drake_haptics {
namespace {

std::vector<Triangle> Members(std::span<const Triangle> triangles,
                              std::span<const int> members) {
  std::vector<Triangle> chosen;
  for (const int t : members) chosen.push_back(triangles[t]);
  return chosen;
}

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
                           std::span<const Triangle> triangles,
                           std::span<const int> members)
    : vertices_(vertices),
      triangles_(triangles),
      members_(members),
      tree_(TriangleBoxes(vertices, Members(triangles, members))) {}

double MeshCoverage::CoveredArea(std::span<const Vec3> polygon,
                                 const Vec3& normal, double tolerance) const {
  const std::vector<Plane> prism = Prism(polygon, normal, tolerance);
  AabbTree::Box box;
  for (const Vec3& corner : polygon) {
    box.extend(corner + Vec3::Constant(tolerance));
    box.extend(corner - Vec3::Constant(tolerance));
  }
  double covered = 0;
  tree_.AnyOverlap(box, [&](int member) {
    const Triangle& t = triangles_[members_[member]];
    const Vec3 &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
    if ((b - a).cross(c - a).dot(normal) > 0) {
      covered += PolygonArea(ClipPolygon({a, b, c}, prism, 0));
    }
    return false;
  });
  return covered;
}

}  // namespace drake_haptics
