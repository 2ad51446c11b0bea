#include "mesh/convex_solid.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "convex/affine_basis.h"
#include "convex/convex_hull.h"
#include "mesh/mesh_edges.h"

namespace drake_haptics {
namespace {

// Relative to the component's size.
constexpr double kConvexTolerance = 1e-6;

// The boundary of a component's hull, to test what is near it.
class HullBoundary {
 public:
  HullBoundary(std::span<const Vec3> points, const AffineBasis& basis) {
    const ConvexHull hull(points, basis.point);
    start_.assign(points.size() + 1, 0);
    hull.ForEachTriangle([&](const HullTriangle& t) {
      planes_.push_back({t.normal, t.normal.dot(points[t.vertex[0]])});
      for (const int v : t.vertex) corners_.emplace_back(v, planes_.size() - 1);
    });
    std::sort(corners_.begin(), corners_.end());
    for (const auto& [point, plane] : corners_) ++start_[point + 1];
    for (std::size_t p = 0; p < points.size(); ++p) start_[p + 1] += start_[p];
  }

  // If all corners are near one plane, the whole triangle is near the boundary.
  // Mostly that plane is at one of its corners.
  bool IsNear(const std::array<int, 3>& triangle, std::span<const Vec3> points,
              double tolerance) const {
    const auto near = [&](const Plane& plane) {
      return std::all_of(triangle.begin(), triangle.end(), [&](int p) {
        return plane.Height(points[p]) >= -tolerance;
      });
    };
    for (const int p : triangle) {
      for (int i = start_[p]; i < start_[p + 1]; ++i) {
        if (near(planes_[corners_[i].second])) return true;
      }
    }
    return std::any_of(planes_.begin(), planes_.end(), near);
  }

  const std::vector<Plane>& planes() const { return planes_; }

 private:
  std::vector<Plane> planes_;
  std::vector<std::pair<int, int>>
      corners_;             // Point, and a plane there; sorted.
  std::vector<int> start_;  // Start of each point in corners_.
};

bool BoundsMaterial(const SurfaceMesh& mesh, std::span<const int> triangles) {
  double volume = 0;
  for (const int t : triangles) {
    const bool closed =
        std::all_of(mesh.neighbors[t].begin(), mesh.neighbors[t].end(),
                    [](int neighbor) { return neighbor >= 0; });
    if (!mesh.solid[t] || !closed) return false;
    const Triangle& v = mesh.triangles[t];
    volume +=
        mesh.vertices[v[0]].dot(mesh.vertices[v[1]].cross(mesh.vertices[v[2]]));
  }
  return volume > 0;
}

}  // namespace

std::vector<Plane> FindConvexSolid(const SurfaceMesh& mesh,
                                   std::span<const int> triangles) {
  if (!BoundsMaterial(mesh, triangles)) return {};
  const std::vector<int> used = VerticesOf(mesh.triangles, triangles);
  std::vector<Vec3> points;
  Eigen::AlignedBox3d box;
  for (const int v : used) {
    points.push_back(mesh.vertices[v]);
    box.extend(points.back());
  }
  const double tolerance =
      std::max(2 * mesh.tolerance, kConvexTolerance * box.diagonal().norm());
  const AffineBasis basis =
      FindAffineBasis(points, kFlatTolerances * tolerance);
  if (basis.dimension < 3) return {};

  const HullBoundary boundary(points, basis);
  const auto index_of = [&](int vertex) {
    return static_cast<int>(std::lower_bound(used.begin(), used.end(), vertex) -
                            used.begin());
  };
  const bool is_convex =
      std::all_of(triangles.begin(), triangles.end(), [&](int t) {
        const Triangle& v = mesh.triangles[t];
        return boundary.IsNear({index_of(v[0]), index_of(v[1]), index_of(v[2])},
                               points, tolerance);
      });
  return is_convex ? boundary.planes() : std::vector<Plane>{};
}

}  // namespace drake_haptics
