#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

/// A plane that supports something: normal · x <= offset there.
struct Plane {
  Vec3 normal = Vec3::Zero();  ///< unit; zero for a triangle without a plane
  double offset = 0;

  double Height(const Vec3& point) const { return normal.dot(point) - offset; }
};

/// Triangles that are connected and lie in the plane of the largest of them.
struct PlanarRegion {
  Plane plane;
  std::vector<int> triangles;
  bool is_convex = false;  ///< together they are one convex polygon
};

/// A triangle mesh with what the growth of patches asks about it. Lengths are
/// scaled by a power of two, as the predicates want them.
struct SurfaceMesh {
  double tolerance = 0;  ///< planes closer than this are one
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> solid;
  std::vector<Plane> planes;  ///< of each triangle
  std::vector<double> areas;  ///< of each triangle
  /// Across edge k (corner k to k + 1): the triangle that shares this edge, and
  /// nobody else, with the same winding; -1 if there is none.
  std::vector<std::array<int, 3>> neighbors;
  std::vector<int> region;  ///< of each triangle
  std::vector<PlanarRegion> regions;
  std::vector<int> component;  ///< of each triangle, connected by any edge
  int num_components = 0;
};

/// Triangles of a hull within this many tolerances of a plane are one facet. A
/// mesh triangle that is thinner has no plane of its own.
inline constexpr double kFacetTolerances = 3;

/// A hull thinner than this counts as flat: the inset of the obstacle test
/// would leave it no interior, and nothing would keep it in the solid.
inline constexpr double kFlatTolerances = 12;

/// Distance, m, below which points count as lying in a plane: 1e-7 of the
/// bounding box diagonal, for the vertices that triangles use. If all their
/// coordinates are numbers of single precision, then they were rounded to it,
/// and the tolerance is no less than what that can have moved two points apart;
/// that counts for meshes far from their origin. More than 1e-5 it never is.
double SurfaceTolerance(std::span<const Vec3> vertices,
                        std::span<const Triangle> triangles);

/// Indices of the longest and the second longest edge of a triangle.
std::array<int, 2> LongSides(const SurfaceMesh& mesh, const Triangle& triangle);

SurfaceMesh MakeSurfaceMesh(std::span<const Vec3> vertices,
                            std::span<const Triangle> triangles,
                            std::span<const std::uint8_t> solid);

}  // namespace drake_haptics
