// The rules by which a triangle joins a patch (paper, 5.3.1; S. A. Ehmann and
// M. C. Lin, "Accurate and Fast Proximity Queries Between Polyhedra Using
// Convex Surface Decomposition", 2001):
//
// - It shares a manifold edge with the patch, with the same winding.
// - The planes of all triangles have all vertices of the patch on or below
//   them, within kSurfaceTolerance of the mesh's size: all triangles are on the
//   boundary of the patch's hull.
// - No other triangle of the same solid meets the interior of the hull, which
//   begins 4 kSurfaceTolerance below its surface. So the hull is in the solid:
//   the wall of a cup does not become a filled cylinder.
// - Each facet of the hull is all surface or not at all. So a planar patch is a
//   convex polygon, without notches and holes.
// - Where the surface bounds no solid, the patch stays in one plane.
#include "decomposition.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "decomposition_input.h"
#include "hull_shape.h"
#include "patch_growth.h"
#include "surface_mesh.h"
#include "surface_provenance.h"

namespace drake_haptics {
namespace {

// A facet's plane goes through the largest triangle of the hull, that of a
// patch through the largest triangle of the mesh: both are within the
// tolerance, so their facets are within twice that and a margin.
constexpr double kFacetTolerances = 3;

std::vector<std::vector<int>> TrianglesOfPieces(
    std::span<const int> piece_of_triangle) {
  const int num_pieces =
      1 + *std::max_element(piece_of_triangle.begin(), piece_of_triangle.end());
  if (num_pieces > static_cast<int>(piece_of_triangle.size())) {
    throw std::invalid_argument("piece numbers must not skip");
  }
  std::vector<std::vector<int>> members(num_pieces);
  for (std::size_t t = 0; t < piece_of_triangle.size(); ++t) {
    if (piece_of_triangle[t] < 0) {
      throw std::invalid_argument("each triangle must have a piece");
    }
    members[piece_of_triangle[t]].push_back(static_cast<int>(t));
  }
  for (const std::vector<int>& triangles : members) {
    if (triangles.empty()) {
      throw std::invalid_argument("piece numbers must not skip");
    }
  }
  return members;
}

// A flat hull's front is the side that the mesh faces to.
void TurnFrontToMesh(const Vec3& normal, HullShape* shape) {
  if (shape->dimension == 2 && shape->polygons[0].normal.dot(normal) < 0) {
    std::swap(shape->polygons[0], shape->polygons[1]);
  }
}

Polytope MakePiece(const MeshTopology& mesh, std::span<const int> patch,
                   double tolerance) {
  std::vector<int> corners;
  Vec3 area = Vec3::Zero();
  for (const int t : patch) {
    const Triangle& triangle = mesh.triangles[t];
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    const Vec3& a = mesh.vertices[triangle[0]];
    area +=
        (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Vec3> points;
  for (const int v : corners) points.push_back(mesh.vertices[v]);
  HullShape shape = FindHullShape(points, kFacetTolerances * tolerance);
  TurnFrontToMesh(area, &shape);
  Polytope piece = MakePolytope(points, shape);
  std::vector<int> source;
  for (const int i : shape.extreme) source.push_back(corners[i]);
  MarkSurface(mesh, patch, source, 2 * kFacetTolerances * tolerance, &piece);
  return piece;
}

}  // namespace

void CheckMesh(std::span<const Vec3> vertices,
               std::span<const Triangle> triangles) {
  if (triangles.empty()) {
    throw std::invalid_argument("a mesh needs one triangle or more");
  }
  if (!AreUsable(vertices)) {
    throw std::invalid_argument(
        "a mesh's coordinates must be finite and below 1e100 m");
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
  const MeshTopology topology(result.vertices, result.triangles);
  const double tolerance = SurfaceTolerance(result.vertices, result.triangles);
  for (const std::vector<int>& patch : TrianglesOfPieces(piece_of_triangle)) {
    result.pieces.push_back(MakePiece(topology, patch, tolerance));
  }
  return result;
}

}  // namespace drake_haptics
