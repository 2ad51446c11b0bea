#pragma once

#include <span>
#include <vector>

#include "mesh/aabb_tree.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

/// Measures how much of a convex polygon some triangles of a mesh cover.
class MeshCoverage {
 public:
  /// @param vertices of the mesh; they must outlive this.
  /// @param triangles those that count.
  MeshCoverage(std::span<const Vec3> vertices, std::vector<Triangle> triangles);

  /// Area, m², of the triangles that face as the polygon does, clipped to the
  /// prism within `tolerance` (m) above and below the polygon.
  /// @param polygon corners, counter-clockwise about the unit `normal`.
  double CoveredArea(std::span<const Vec3> polygon, const Vec3& normal,
                     double tolerance) const;

 private:
  std::span<const Vec3> vertices_;
  std::vector<Triangle> triangles_;
  AabbTree tree_;
};

}  // namespace drake_haptics
