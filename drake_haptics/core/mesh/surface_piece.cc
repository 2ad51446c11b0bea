#include "mesh/surface_piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <utility>

#include "convex/hull_shape.h"
#include "mesh/convex_clip.h"
#include "mesh/mesh_coverage.h"
#include "mesh/surface_mesh.h"

namespace drake_haptics {
namespace {

// A facet's plane contains the largest triangle of the hull, a patch's plane
// the largest triangle of the mesh. A triangle may thus be twice as far from
// its facet as a triangle may be from either plane.
constexpr double kOnFacetTolerances = 2 * kFacetTolerances;

Vec3 AreaVector(const MeshTopology& mesh, int triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) / 2;
}

// Whether the patch has no border, and so is all of the hull's boundary.
bool IsClosed(const MeshTopology& mesh, std::span<const int> patch) {
  return std::all_of(patch.begin(), patch.end(), [&](int t) {
    const Triangle& triangle = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const auto sides = mesh.SidesOf(triangle[k], triangle[(k + 1) % 3]);
      if (std::count_if(sides.begin(), sides.end(), [&](const auto& side) {
            return std::binary_search(patch.begin(), patch.end(),
                                      side.triangle);
          }) != 2) {
        return false;
      }
    }
    return true;
  });
}

// Makes the side that the mesh faces the front of a flat hull. It is all
// surface: patches do not leave facets half covered.
void TurnFrontToMesh(const Vec3& normal, HullShape* shape) {
  if (shape->dimension != 2) return;
  if (shape->polygons[0].normal.dot(normal) < 0) {
    std::swap(shape->polygons[0], shape->polygons[1]);
  }
  shape->polygons[1].original = false;
}

HullShape FindOpenShape(const MeshTopology& mesh, std::span<const int> patch,
                        std::span<const Vec3> points, double tolerance) {
  std::vector<Triangle> triangles;
  for (const int t : patch) triangles.push_back(mesh.triangles[t]);
  const MeshCoverage cover(mesh.vertices, std::move(triangles));
  const auto is_on_surface = [&](const std::array<int, 3>& corners,
                                 const Vec3& normal) {
    const std::array<Vec3, 3> polygon{points[corners[0]], points[corners[1]],
                                      points[corners[2]]};
    return cover.CoveredArea(polygon, normal, kOnFacetTolerances * tolerance) >
           PolygonArea(polygon) / 2;
  };
  HullShape shape =
      FindHullShape(points, kFacetTolerances * tolerance, is_on_surface);
  Vec3 area = Vec3::Zero();
  for (const int t : patch) area += AreaVector(mesh, t);
  TurnFrontToMesh(area, &shape);
  return shape;
}

bool LiesOnOriginalFacet(const MeshTopology& mesh, int triangle,
                         double tolerance, const Polytope& piece) {
  const Triangle& corners = mesh.triangles[triangle];
  const Vec3 area = AreaVector(mesh, triangle);
  return std::any_of(
      piece.facets.begin(), piece.facets.end(), [&](const auto& facet) {
        return facet.original && facet.normal.dot(area) >= 0 &&
               std::all_of(corners.begin(), corners.end(), [&](int v) {
                 return std::abs(facet.normal.dot(mesh.vertices[v]) -
                                 facet.offset) <= tolerance;
               });
      });
}

// Whether original facets and triangles have the same area, except for slivers.
bool HaveEqualAreas(const MeshTopology& mesh, std::span<const int> patch,
                    double tolerance, const Polytope& piece) {
  double patch_area = 0, facet_area = 0, perimeter = 0;
  for (const int t : patch) patch_area += AreaVector(mesh, t).norm();
  for (std::size_t f = 0; f < piece.facets.size(); ++f) {
    if (!piece.facets[f].original) continue;
    std::vector<Vec3> polygon;
    for (const int v : piece.loop_of(static_cast<int>(f))) {
      polygon.push_back(piece.vertices[v]);
    }
    facet_area += PolygonArea(polygon);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      perimeter += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
    }
  }
  constexpr double kRoundOff = 1e-9;
  return std::abs(facet_area - patch_area) <=
         kRoundOff * patch_area + tolerance * perimeter;
}

// Triangles that lie on no original facet, or all if the original facets have a
// different area.
std::vector<int> FindLost(const MeshTopology& mesh, std::span<const int> patch,
                          double tolerance, const Polytope& piece) {
  std::vector<int> lost;
  for (const int t : patch) {
    if (!LiesOnOriginalFacet(mesh, t, tolerance, piece)) lost.push_back(t);
  }
  if (lost.empty() && !HaveEqualAreas(mesh, patch, tolerance, piece)) {
    lost.assign(patch.begin(), patch.end());
  }
  return lost;
}

}  // namespace

SurfacePiece MakeSurfacePiece(std::span<const int> patch, double tolerance,
                              MeshTopology* mesh) {
  assert(!patch.empty() && std::is_sorted(patch.begin(), patch.end()));
  const std::vector<int> corners = VerticesOf(mesh->triangles, patch);
  std::vector<Vec3> points;
  for (const int v : corners) points.push_back(mesh->vertices[v]);

  const bool closed = IsClosed(*mesh, patch);
  const HullShape shape =
      closed ? FindHullShape(points, kFacetTolerances * tolerance)
             : FindOpenShape(*mesh, patch, points, tolerance);
  SurfacePiece piece{MakePolytope(points, shape), {}};
  // The hull of a closed patch is the whole surface. Mesh edges that end at no
  // corner of the hull, and may be shorter than the hull is exact, would
  // contradict that.
  if (closed && shape.extreme.size() < corners.size()) return piece;
  std::vector<int> source;
  for (const int i : shape.extreme) source.push_back(corners[i]);
  const double on_facet = kOnFacetTolerances * tolerance;
  ConnectToSurface(patch, source, on_facet, mesh, &piece.polytope);
  if (patch.size() > 1 && !closed) {
    piece.lost = FindLost(*mesh, patch, on_facet, piece.polytope);
  }
  return piece;
}

}  // namespace drake_haptics
