#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "law/vertex_normals.h"
#include "mesh/aabb_tree.h"

namespace drake_haptics {

/// A triangle with all that interpolation reads.
struct ShadedTriangle {
  std::array<Vec3, 3> points;  ///< m
  std::array<ShadedCorner, 3> corners;
};

/// A facet of a piece with the triangles of the mesh that it was made from.
class ShadedFacet {
 public:
  /// @param normal of the facet, unit.
  /// @param triangles those on it that have an area; none if it was not made
  ///        from triangles: then its own normal is all there is.
  /// @param size of the piece, m, by which round-off is judged.
  ShadedFacet(const Vec3& normal, std::vector<ShadedTriangle> triangles,
              double size);

  const Vec3& normal() const { return normal_; }

  /// Normal, not unit, and curvature at a point of the facet's plane (m):
  /// beyond the facet as the curvature at its nearest point tells.
  template <typename T>
  ShadedCornerOf<T> Interpolate(const Eigen::Matrix<T, 3, 1>& p) const;

 private:
  Vec3 normal_;
  std::vector<ShadedTriangle> triangles_;  // none if all have its own normal
  AabbTree tree_;                          // over many
  double reach_;
};

}  // namespace drake_haptics
