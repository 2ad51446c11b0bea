#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/types.h"
#include "convex/polytope.h"

namespace drake_haptics {

using Triangle = Eigen::Vector3i;

/// Corners of a triangle, m.
inline std::array<Vec3, 3> CornersOf(std::span<const Vec3> vertices,
                                     const Triangle& triangle) {
  return {vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]};
}

/// A mesh and the convex pieces that stand for its surface.
struct Decomposition {
  std::vector<Vec3> vertices;       ///< of the mesh, m, in the object's frame
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
  /// For each piece, the polytope that a query runs on.
  std::vector<Polytope> pieces;
  /// Piece of each triangle; -1 where pieces were not made from triangles.
  std::vector<int> piece_of_triangle;
};

/// Triangles of each of `num_pieces` pieces; those of no piece are left out.
std::vector<std::vector<int>> TrianglesOfPieces(
    std::span<const int> piece_of_triangle, int num_pieces);

/// @throws std::invalid_argument if there is no triangle, an index is out of
/// range or a coordinate is not finite and below 1e50 m.
void CheckMesh(std::span<const Vec3> vertices,
               std::span<const Triangle> triangles);

/// Called now and then with the share done in [0, 1]; stops the work if it
/// returns false.
using Progress = std::function<bool(double)>;

/// Convex surface decomposition (paper, 5.3.1; Ehmann and Lin 2001): patches
/// grown breadth first over the dual graph for as long as the patch is convex
/// and its hull stays inside the solid. See decomposition.cc for the rules.
/// `solid` says for each triangle whether it bounds a solid (its component is
/// closed and wound outward); the patches of other triangles are flat, since
/// they have no inside. A solid that differs from its hull by noise alone is
/// one piece. Pieces leave the solid by no more than 1e-6 of the mesh's size,
/// or more in a mesh far from its origin in single precision (see
/// SurfaceTolerance). Deterministic.
/// @throws std::invalid_argument for bad indices or values,
///         std::runtime_error when `progress` asked to stop.
Decomposition DecomposeSurface(std::span<const Vec3> vertices,
                               std::span<const Triangle> triangles,
                               std::span<const std::uint8_t> solid,
                               const Progress& progress = {});

/// Makes the same result from known labels (a cache), without the search.
/// Triangles that would be on no original facet of their piece get pieces of
/// their own.
Decomposition AssembleSurfacePieces(std::span<const Vec3> vertices,
                                    std::span<const Triangle> triangles,
                                    std::span<const int> piece_of_triangle);

/// Adopts pieces made elsewhere (CoACD, or one hull): facets within `tolerance`
/// (m) of the mesh that face as it does are original, all others virtual. If
/// the tolerance is infinite, the pieces replace the mesh: all facets are
/// original.
Decomposition AdoptConvexPieces(std::span<const Vec3> vertices,
                                std::span<const Triangle> triangles,
                                std::span<const std::vector<Vec3>> pieces,
                                double tolerance);

}  // namespace drake_haptics
