#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/autodiff.h"
#include "base/types.h"
#include "convex/polytope.h"
#include "mesh/decomposition.h"

namespace drake_haptics {

/// Finds vertices of a piece by their coordinates, which are copies of the
/// mesh's.
class PieceVertices {
 public:
  /// @param piece must outlive this.
  explicit PieceVertices(const Polytope& piece);

  /// Vertex at exactly this point, or -1.
  int Find(const Vec3& point) const;

 private:
  const std::vector<Vec3>& vertices_;
  std::vector<int> order_;  // vertices, sorted by coordinates
};

/// Returns the original facet on which each triangle of a piece lies; -1 for a
/// triangle without area. Corners that are vertices of the piece leave few
/// candidates, of which the facet nearest to the corners is taken.
/// @param triangles indices of triangles of `mesh` that the piece was made
///        from.
std::vector<int> FacetsOfTriangles(const Decomposition& mesh,
                                   const Polytope& piece,
                                   std::span<const int> triangles);

/// Point of a triangle that is nearest to a given one.
template <typename T>
struct NearestInTriangleOf {
  /// Barycentric coordinates: at least 0, and 1 in sum.
  std::array<T, 3> weights;
  T squared_distance{0};  ///< m²; zero if it projects into the triangle
};

/// @param corners of a triangle with an area, m.
/// @param p in the plane of the triangle or near to it: its height above the
///        plane does not count.
template <typename T>
NearestInTriangleOf<T> FindNearestInTriangle(const std::array<Vec3, 3>& corners,
                                             const Eigen::Matrix<T, 3, 1>& p);

}  // namespace drake_haptics
