#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

/// A supporting plane: normal · x <= offset in the body that it supports.
struct Plane {
  Vec3 normal = Vec3::Zero();  ///< unit; zero for a triangle without a plane
  double offset = 0;

  double Height(const Vec3& point) const { return normal.dot(point) - offset; }
};

/// Connected triangles in the plane of the largest of them.
struct PlanarRegion {
  Plane plane;
  std::vector<int> triangles;
  double area = 0;         ///< of all triangles
  bool is_convex = false;  ///< together they are one convex polygon
};

/// A triangle mesh with the data that patch growth needs. Lengths are scaled by
/// a power of two, as the predicates require.
struct SurfaceMesh {
  double tolerance = 0;  ///< planes closer than this are one
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> solid;
  std::vector<Plane> planes;  ///< of each triangle
  std::vector<double> areas;  ///< of each triangle
  /// Across edge k (corner k to k + 1): the only other triangle with this edge,
  /// if it has the same winding; else -1.
  std::vector<std::array<int, 3>> neighbors;
  std::vector<int> region;  ///< of each triangle
  std::vector<PlanarRegion> regions;
  std::vector<int> component;  ///< of each triangle; any shared edge connects
  int num_components = 0;
};

/// Triangles of a hull within this many tolerances of a plane are one facet. A
/// mesh triangle that is thinner has no plane of its own.
inline constexpr double kFacetTolerances = 3;

/// A hull thinner than this many tolerances counts as flat: the inset of the
/// obstacle test would leave it no interior, and nothing would keep it in the
/// solid.
inline constexpr double kFlatTolerances = 12;

/// Distance, m, below which points count as lying in a plane: 1e-7 of the
/// diagonal of the bounding box of the vertices that triangles use. If all
/// their coordinates are single-precision numbers, the tolerance is at least
/// the distance that rounding can have moved two points apart, which matters
/// for meshes far from their origin. It is at most 1e-5 of the diagonal.
double SurfaceTolerance(std::span<const Vec3> vertices,
                        std::span<const Triangle> triangles);

/// Indices of the longest and the second longest edge of a triangle.
std::array<int, 2> LongSides(const SurfaceMesh& mesh, const Triangle& triangle);

SurfaceMesh MakeSurfaceMesh(std::span<const Vec3> vertices,
                            std::span<const Triangle> triangles,
                            std::span<const std::uint8_t> solid);

}  // namespace drake_haptics
