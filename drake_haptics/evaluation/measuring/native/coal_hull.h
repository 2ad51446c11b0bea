#pragma once

#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>
#include <vector>

namespace bench {

using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The hull of n points, ready for every start of GJK.
inline std::shared_ptr<coal::CollisionGeometry> CoalHull(const double* points,
                                                         int n) {
  auto vertices = std::make_shared<std::vector<coal::Vec3s>>();
  for (int i = 0; i < n; ++i) vertices->emplace_back(points + 3 * i);
  std::shared_ptr<coal::CollisionGeometry> hull(
      coal::ConvexBase::convexHull(vertices, n, true, "Qt"));
  hull->computeLocalAABB();
  return hull;
}

/// A convex polytope whose facets are known, cut into triangles.
inline std::shared_ptr<coal::CollisionGeometry> CoalConvex(
    const double* points, int num_points, const int* triangles,
    int num_triangles) {
  auto vertices = std::make_shared<std::vector<coal::Vec3s>>();
  for (int i = 0; i < num_points; ++i) vertices->emplace_back(points + 3 * i);
  auto facets = std::make_shared<std::vector<coal::Triangle>>();
  for (int i = 0; i < num_triangles; ++i) {
    const int* t = triangles + 3 * i;
    facets->emplace_back(t[0], t[1], t[2]);
  }
  auto hull = std::make_shared<coal::Convex<coal::Triangle>>(
      vertices, num_points, facets, num_triangles);
  hull->computeLocalAABB();
  return hull;
}

/// From a row-major 4x4 matrix.
inline coal::Transform3s CoalPose(const double* X) {
  coal::Matrix3s R;
  R << X[0], X[1], X[2], X[4], X[5], X[6], X[8], X[9], X[10];
  return {R, coal::Vec3s(X[3], X[7], X[11])};
}

}  // namespace bench
