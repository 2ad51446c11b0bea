#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "law/vertex_normals.h"
#include "mesh/aabb_tree.h"

namespace drake_haptics {

/// A triangle with the data for interpolation.
struct ShadedTriangle {
  std::array<Vec3, 3> points;  ///< m
  std::array<ShadedCorner, 3> corners;
};

/// A facet of a piece with the triangles of the mesh that it was made from.
class ShadedFacet {
 public:
  /// @param normal of the facet, unit.
  /// @param triangles those on the facet that have an area; none if it was not
  ///        made from triangles: then its own normal counts.
  /// @param size of the piece, m, the scale of round-off.
  ShadedFacet(const Vec3& normal, std::vector<ShadedTriangle> triangles,
              double size);

  const Vec3& normal() const { return normal_; }

  /// Normal, not unit, and curvature at a point of the facet's plane (m).
  /// Beyond the facet, the curvature at its nearest point extends the normal.
  template <typename T>
  ShadedCornerOf<T> Interpolate(const Eigen::Matrix<T, 3, 1>& p) const;

 private:
  Vec3 normal_;
  std::vector<ShadedTriangle> triangles_;  // empty if all have normal_
  AabbTree tree_;                          // empty if they are few
  double reach_;
};

}  // namespace drake_haptics
