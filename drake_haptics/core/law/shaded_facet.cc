#include "law/shaded_facet.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "law/facet_triangles.h"

namespace drake_haptics {
namespace {

// Normals within this angle (rad) of the facet's count as the same.
constexpr double kFlat = 1e-6;
// Above this number a tree finds the triangle under a point faster.
constexpr std::size_t kFewTriangles = 4;
// Largest distance of a facet from its triangles, as a share of the piece's
// size: the tolerance for merging coplanar triangles (surface_mesh.h).
constexpr double kReach = 1e-5;

bool IsFlat(const ShadedTriangle& triangle, const Vec3& normal, double size) {
  return std::all_of(triangle.corners.begin(), triangle.corners.end(),
                     [&](const ShadedCorner& corner) {
                       return (corner.normal - normal).norm() <= kFlat &&
                              corner.curvature.norm() * size <= kFlat;
                     });
}

AabbTree MakeTree(const std::vector<ShadedTriangle>& triangles) {
  std::vector<AabbTree::Box> boxes;
  if (triangles.size() > kFewTriangles) {
    for (const ShadedTriangle& triangle : triangles) {
      AabbTree::Box& box = boxes.emplace_back();
      for (const Vec3& point : triangle.points) box.extend(point);
    }
  }
  return AabbTree(std::move(boxes));
}

}  // namespace

ShadedFacet::ShadedFacet(const Vec3& normal,
                         std::vector<ShadedTriangle> triangles, double size)
    : normal_(normal),
      triangles_(std::all_of(triangles.begin(), triangles.end(),
                             [&](const ShadedTriangle& triangle) {
                               return IsFlat(triangle, normal, size);
                             })
                     ? std::vector<ShadedTriangle>()
                     : std::move(triangles)),
      tree_(MakeTree(triangles_)),
      reach_(kReach * size) {}

template <typename T>
ShadedCornerOf<T> ShadedFacet::Interpolate(
    const Eigen::Matrix<T, 3, 1>& p) const {
  if (triangles_.empty()) {
    return {normal_.template cast<T>(), Mat3Of<T>::Zero()};
  }
  const Vec3 place = ValuesOf(p);
  const ShadedTriangle* best = nullptr;
  NearestInTriangleOf<T> nearest;
  nearest.squared_distance = T(std::numeric_limits<double>::infinity());
  const auto is_under = [&](const ShadedTriangle& triangle) {
    const auto found = FindNearestInTriangle<T>(triangle.points, p);
    if (!best || found.squared_distance < nearest.squared_distance) {
      best = &triangle;
      nearest = found;
    }
    return found.squared_distance == 0.0;
  };
  const Vec3 reach = Vec3::Constant(reach_);
  tree_.AnyOverlap({place - reach, place + reach},
                   [&](int i) { return is_under(triangles_[i]); });
  // Few triangles, or a point off the facet.
  if (nearest.squared_distance > reach_ * reach_) {
    std::any_of(triangles_.begin(), triangles_.end(), is_under);
  }
  ShadedCornerOf<T> sum;
  for (int k = 0; k < 3; ++k) {
    const ShadedCorner& corner = best->corners[k];
    sum.normal += nearest.weights[k] * corner.normal.template cast<T>();
    sum.curvature += nearest.weights[k] * corner.curvature.template cast<T>();
  }
  if (nearest.squared_distance > 0.0) {
    // Off the facet, as where its plane continues beyond a concave edge, the
    // surface keeps the curvature of the border.
    Vec3Of<T> beyond = p;
    for (int k = 0; k < 3; ++k) {
      beyond -= nearest.weights[k] * best->points[k].template cast<T>();
    }
    const Vec3Of<T> normal = normal_.template cast<T>();
    beyond -= normal * normal.dot(beyond);
    sum.normal += sum.curvature * beyond;
  }
  return sum;
}

template ShadedCorner ShadedFacet::Interpolate(const Vec3&) const;
template ShadedCornerOf<AutoDiff> ShadedFacet::Interpolate(
    const Vec3Of<AutoDiff>&) const;

}  // namespace drake_haptics
