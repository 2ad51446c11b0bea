#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "decomposition.h"
#include "types.h"

namespace drake_haptics {

/// A corner of a triangle as shading sees it.
struct ShadedCorner {
  Vec3 normal = Vec3::Zero();  ///< unit; zero on a triangle without area
  /// How the interpolated normal changes over the surface, 1/m: it turns by
  /// curvature · v on the way v. Symmetric; positive where the surface is
  /// convex. That of a sphere is (I − n nᵀ) / radius.
  Mat3 curvature = Mat3::Zero();
};

/// The normals of a mesh for Gouraud shading.
struct VertexNormals {
  /// Corner by corner of each triangle.
  std::vector<std::array<ShadedCorner, 3>> corners;
  /// For each vertex, whether one smooth surface goes all the way round it.
  std::vector<std::uint8_t> smooth;
};

/// Gives each corner of each triangle the mean of the unit normals of the
/// triangles around its vertex, weighted with their angles there, among those
/// that are reached across edges whose dihedral angle is below the crease
/// angle. So a vertex on a crease has one normal for each side of it. Edges
/// that are not shared by two triangles of the same winding are creases. The
/// curvature is the mean of the same triangles, weighted with their areas.
/// @param vertices positions, m.
/// @param crease_angle rad, in [0, π].
VertexNormals ComputeVertexNormals(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles,
                                   double crease_angle);

}  // namespace drake_haptics
