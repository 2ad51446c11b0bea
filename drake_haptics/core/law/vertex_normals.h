#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/autodiff.h"
#include "base/types.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

/// Normal and curvature at a corner of a triangle, for shading.
template <typename T>
struct ShadedCornerOf {
  Vec3Of<T> normal = Vec3Of<T>::Zero();  ///< unit; zero if without area
  /// Derivative of the interpolated normal along the surface, 1/m: it turns by
  /// curvature · v over the displacement v. Symmetric; positive where the
  /// surface is convex; (I − n nᵀ) / radius for a sphere.
  Mat3Of<T> curvature = Mat3Of<T>::Zero();
};
using ShadedCorner = ShadedCornerOf<double>;

/// The normals of a mesh for Gouraud shading.
struct VertexNormals {
  /// For each corner of each triangle.
  std::vector<std::array<ShadedCorner, 3>> corners;
  /// For each vertex, whether one smooth surface surrounds it.
  std::vector<std::uint8_t> smooth;
};

/// Gives each corner of each triangle the mean of the unit normals of the
/// triangles around its vertex, weighted with their angles there, over those
/// that are reached across edges whose dihedral angle is below the crease
/// angle. So a vertex on a crease has one normal for each side. Edges that are
/// not shared by two triangles of the same winding are creases. The curvature
/// is the mean over the same triangles, weighted with their areas.
/// @param vertices positions, m.
/// @param crease_angle rad, in [0, π].
VertexNormals ComputeVertexNormals(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles,
                                   double crease_angle);

}  // namespace drake_haptics
