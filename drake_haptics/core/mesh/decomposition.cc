// The rules by which a triangle joins a patch (paper, 5.3.1; S. A. Ehmann and
// M. C. Lin, "Accurate and Fast Proximity Queries Between Polyhedra Using
// Convex Surface Decomposition", 2001):
//
// - It shares a manifold edge with the patch, with the same winding.
// - All vertices of the patch are on or below the planes of all triangles,
//   within the surface tolerance (see surface_mesh.h): all triangles are on the
//   boundary of the patch's hull.
// - No other triangle of the same solid meets the interior of the hull, which
//   begins 4 tolerances below its surface. So the hull is in the solid: the
//   wall of a cup does not become a filled cylinder.
// - Each facet of the hull is all surface or none of it is. So a planar patch
//   is a convex polygon, without notches and holes.
// - Where the surface bounds no solid, the patch stays in one plane.
//
// A component that is convex except for noise is one patch (see
// convex_solid.h). A triangle that would be on no original facet of its piece
// gets a piece of its own. Pieces lie in the solid; with noise they leave it by
// no more than 1e-6 of the mesh's size or ten tolerances, whichever is more.
#include "mesh/decomposition.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

#include "convex/hull_shape.h"
#include "mesh/patch_growth.h"
#include "mesh/surface_mesh.h"
#include "mesh/surface_piece.h"

namespace drake_haptics {
namespace {

// @throws std::invalid_argument unless each triangle has a piece, and each
// piece a triangle.
std::vector<std::vector<int>> RequirePieces(
    std::span<const int> piece_of_triangle) {
  const int last =
      *std::max_element(piece_of_triangle.begin(), piece_of_triangle.end());
  if (last >= static_cast<int>(piece_of_triangle.size())) {
    throw std::invalid_argument("piece numbers must not skip");
  }
  if (*std::min_element(piece_of_triangle.begin(), piece_of_triangle.end()) <
      0) {
    throw std::invalid_argument("each triangle must have a piece");
  }
  std::vector<std::vector<int>> members =
      TrianglesOfPieces(piece_of_triangle, last + 1);
  for (const std::vector<int>& triangles : members) {
    if (triangles.empty()) {
      throw std::invalid_argument("piece numbers must not skip");
    }
  }
  return members;
}

// Gives each lost triangle a patch of its own, at the end of the list. If all
// are lost, the first remains.
void SeparateLost(std::span<const int> lost, std::size_t index,
                  std::vector<std::vector<int>>* patches,
                  std::vector<int>* piece_of_triangle) {
  std::vector<int> rest;
  std::set_difference((*patches)[index].begin(), (*patches)[index].end(),
                      lost.begin(), lost.end(), std::back_inserter(rest));
  if (rest.empty()) {
    rest.push_back(lost.front());
    lost = lost.subspan(1);
  }
  (*patches)[index] = std::move(rest);
  for (const int t : lost) {
    (*piece_of_triangle)[t] = static_cast<int>(patches->size());
    patches->push_back({t});
  }
}

}  // namespace

std::vector<std::vector<int>> TrianglesOfPieces(
    std::span<const int> piece_of_triangle, int num_pieces) {
  std::vector<std::vector<int>> triangles(num_pieces);
  for (int t = 0; t < std::ssize(piece_of_triangle); ++t) {
    const int piece = piece_of_triangle[t];
    if (piece >= 0) triangles[piece].push_back(t);
  }
  return triangles;
}

void CheckMesh(std::span<const Vec3> vertices,
               std::span<const Triangle> triangles) {
  if (triangles.empty()) {
    throw std::invalid_argument("a mesh needs one triangle or more");
  }
  if (!AreUsable(vertices)) {
    throw std::invalid_argument(
        "a mesh's coordinates must be finite and below 1e50 m");
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t]) {
      if (v < 0 || v >= std::ssize(vertices)) {
        throw std::invalid_argument("triangle " + std::to_string(t) +
                                    " names vertex " + std::to_string(v) +
                                    " of " + std::to_string(vertices.size()));
      }
    }
  }
}

Decomposition DecomposeSurface(std::span<const Vec3> vertices,
                               std::span<const Triangle> triangles,
                               std::span<const std::uint8_t> solid,
                               const Progress& progress) {
  CheckMesh(vertices, triangles);
  if (solid.size() != triangles.size()) {
    throw std::invalid_argument("`solid` needs one entry for each triangle");
  }
  const SurfaceMesh mesh = MakeSurfaceMesh(vertices, triangles, solid);
  return AssembleSurfacePieces(vertices, triangles,
                               GrowPatches(mesh, progress));
}

Decomposition AssembleSurfacePieces(std::span<const Vec3> vertices,
                                    std::span<const Triangle> triangles,
                                    std::span<const int> piece_of_triangle) {
  CheckMesh(vertices, triangles);
  if (piece_of_triangle.size() != triangles.size()) {
    throw std::invalid_argument("each triangle must have a piece");
  }
  Decomposition result;
  result.vertices.assign(vertices.begin(), vertices.end());
  result.triangles.assign(triangles.begin(), triangles.end());
  result.piece_of_triangle.assign(piece_of_triangle.begin(),
                                  piece_of_triangle.end());
  MeshTopology topology(result.vertices, result.triangles);
  const double tolerance = SurfaceTolerance(result.vertices, result.triangles);
  std::vector<std::vector<int>> patches = RequirePieces(piece_of_triangle);
  // The list grows in the loop.
  for (std::size_t i = 0; i < patches.size(); ++i) {
    SurfacePiece piece = MakeSurfacePiece(patches[i], tolerance, &topology);
    while (!piece.lost.empty()) {
      SeparateLost(piece.lost, i, &patches, &result.piece_of_triangle);
      piece = MakeSurfacePiece(patches[i], tolerance, &topology);
    }
    result.pieces.push_back(std::move(piece.polytope));
  }
  return result;
}

}  // namespace drake_haptics
