#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "mesh/convex_clip.h"
#include "mesh/decomposition.h"
#include "mesh/mesh_coverage.h"
#include "mesh/patch_surroundings.h"

namespace drake_haptics {
namespace {

// Share of a facet that the mesh must cover for the facet to be original.
constexpr double kCoveredShare = 0.99;

void MarkFacetsOnMesh(const MeshCoverage& mesh, double tolerance,
                      Polytope* piece) {
  for (std::size_t f = 0; f < piece->facets.size(); ++f) {
    Polytope::Facet& facet = piece->facets[f];
    std::vector<Vec3> polygon;
    for (const int v : piece->loop_of(static_cast<int>(f))) {
      polygon.push_back(piece->vertices[v]);
    }
    facet.original = mesh.CoveredArea(polygon, facet.normal, tolerance) >=
                     kCoveredShare * PolygonArea(polygon);
  }
}

}  // namespace

Decomposition AdoptConvexPieces(std::span<const Vec3> vertices,
                                std::span<const Triangle> triangles,
                                std::span<const std::vector<Vec3>> pieces,
                                double tolerance) {
  CheckMesh(vertices, triangles);
  if (!(tolerance >= 0)) {
    throw std::invalid_argument("the tolerance must be zero or more, in m");
  }
  const MeshCoverage mesh(vertices, {triangles.begin(), triangles.end()});
  Decomposition result;
  result.vertices.assign(vertices.begin(), vertices.end());
  result.triangles.assign(triangles.begin(), triangles.end());
  result.piece_of_triangle.assign(triangles.size(), -1);
  for (const std::vector<Vec3>& points : pieces) {
    Polytope piece = MakePolytope(points);
    if (std::isfinite(tolerance)) MarkFacetsOnMesh(mesh, tolerance, &piece);
    MarkEdgesFromFacets(&piece);
    result.pieces.push_back(std::move(piece));
  }
  return result;
}

}  // namespace drake_haptics
