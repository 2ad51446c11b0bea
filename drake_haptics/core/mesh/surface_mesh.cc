#include "mesh/surface_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

#include "base/union_find.h"
#include "convex/flat_hull.h"
#include "convex/predicates.h"
#include "mesh/mesh_edges.h"

namespace drake_haptics {
namespace {

void AddVertices(std::span<const Vec3> vertices, SurfaceMesh* mesh) {
  double magnitude = 0;
  for (const Triangle& t : mesh->triangles) {
    for (const int v : t) {
      magnitude = std::max(magnitude, vertices[v].cwiseAbs().maxCoeff());
    }
  }
  const double scale = PowerOfTwoScale(magnitude);
  mesh->tolerance = SurfaceTolerance(vertices, mesh->triangles) * scale;
  mesh->vertices.reserve(vertices.size());
  for (const Vec3& v : vertices) {
    mesh->vertices.push_back(NormalizeForPredicates(v, scale));
  }
}

double SideLength(const SurfaceMesh& mesh, const Triangle& t, int side) {
  return (mesh.vertices[t[(side + 1) % 3]] - mesh.vertices[t[side]]).norm();
}

void AddPlanes(SurfaceMesh* mesh) {
  for (const Triangle& t : mesh->triangles) {
    const Vec3& a = mesh->vertices[t[0]];
    const Vec3 cross =
        TriangleCross(a, mesh->vertices[t[1]], mesh->vertices[t[2]]);
    mesh->areas.push_back(cross.norm() / 2);
    // The plane of a thin triangle is noise, and would exclude other triangles.
    const bool thin =
        cross.norm() <= kFacetTolerances * mesh->tolerance *
                            SideLength(*mesh, t, LongSides(*mesh, t)[0]);
    const Vec3 normal = thin ? Vec3::Zero() : Vec3(cross.stableNormalized());
    mesh->planes.push_back({normal, normal.dot(a)});
  }
}

void AddNeighborsAndComponents(SurfaceMesh* mesh) {
  const int n = static_cast<int>(mesh->triangles.size());
  mesh->neighbors.assign(n, {-1, -1, -1});
  UnionFind components(n);
  const std::vector<TriangleSide> sides = SortedSides(mesh->triangles);
  ForEachMeshEdge(sides, [&](std::span<const TriangleSide> edge) {
    for (const TriangleSide& side : edge) {
      components.Join(side.triangle, edge[0].triangle);
    }
    if (edge.size() == 2 && edge[0].forward != edge[1].forward) {
      mesh->neighbors[edge[0].triangle][edge[0].edge] = edge[1].triangle;
      mesh->neighbors[edge[1].triangle][edge[1].edge] = edge[0].triangle;
    }
  });
  std::vector<int> number(n, -1);
  for (int t = 0; t < n; ++t) {
    int& component = number[components.Root(t)];
    if (component < 0) component = mesh->num_components++;
    mesh->component.push_back(component);
  }
}

bool LiesIn(const SurfaceMesh& mesh, int t, const Plane& plane) {
  const Triangle& triangle = mesh.triangles[t];
  // Thin triangles may lie in any plane.
  return mesh.planes[t].normal.dot(plane.normal) >= 0 &&
         std::all_of(triangle.begin(), triangle.end(), [&](int v) {
           return std::abs(plane.Height(mesh.vertices[v])) <= mesh.tolerance;
         });
}

PlanarRegion FloodRegion(const SurfaceMesh& mesh, int seed,
                         std::vector<int>* region_of, int region_index) {
  PlanarRegion region{mesh.planes[seed], {seed}, mesh.areas[seed], false};
  (*region_of)[seed] = region_index;
  if (region.plane.normal.isZero(0)) return region;
  for (std::size_t i = 0; i < region.triangles.size(); ++i) {
    for (const int next : mesh.neighbors[region.triangles[i]]) {
      if (next < 0 || (*region_of)[next] >= 0) continue;
      if (!LiesIn(mesh, next, region.plane)) continue;
      (*region_of)[next] = region_index;
      region.triangles.push_back(next);
      region.area += mesh.areas[next];
    }
  }
  return region;
}

bool IsConvexPolygon(const SurfaceMesh& mesh, const PlanarRegion& region) {
  if (region.triangles.size() == 1) return true;
  std::vector<Vec3> points;
  for (const int t : region.triangles) {
    for (const int v : mesh.triangles[t]) points.push_back(mesh.vertices[v]);
  }
  return FindFlatHull(points, region.plane.normal)
      .IsFilledBy(region.area, mesh.tolerance);
}

void AddRegions(SurfaceMesh* mesh) {
  mesh->region.assign(mesh->triangles.size(), -1);
  std::vector<int> order(mesh->triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
    return mesh->areas[i] > mesh->areas[j];
  });
  for (const int seed : order) {
    if (mesh->region[seed] >= 0) continue;
    mesh->regions.push_back(FloodRegion(
        *mesh, seed, &mesh->region, static_cast<int>(mesh->regions.size())));
    mesh->regions.back().is_convex =
        IsConvexPolygon(*mesh, mesh->regions.back());
  }
}

bool IsSinglePrecision(const Vec3& v) {
  return v.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max() &&
         v.cast<float>().cast<double>() == v;
}

}  // namespace

double SurfaceTolerance(std::span<const Vec3> vertices,
                        std::span<const Triangle> triangles) {
  Eigen::AlignedBox3d box;
  bool single = true;
  for (const Triangle& t : triangles) {
    for (const int v : t) {
      box.extend(vertices[v]);
      single = single && IsSinglePrecision(vertices[v]);
    }
  }
  const double size = box.sizes().norm();
  const double magnitude =
      box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double rounding = single ? 2 * 0x1p-24 * magnitude : 0;
  return std::clamp(rounding, 1e-7 * size, 1e-5 * size);
}

std::array<int, 2> LongSides(const SurfaceMesh& mesh,
                             const Triangle& triangle) {
  std::array<int, 3> sides{0, 1, 2};
  std::stable_sort(sides.begin(), sides.end(), [&](int i, int j) {
    return SideLength(mesh, triangle, i) > SideLength(mesh, triangle, j);
  });
  return {sides[0], sides[1]};
}

SurfaceMesh MakeSurfaceMesh(std::span<const Vec3> vertices,
                            std::span<const Triangle> triangles,
                            std::span<const std::uint8_t> solid) {
  SurfaceMesh mesh;
  mesh.triangles.assign(triangles.begin(), triangles.end());
  mesh.solid.assign(solid.begin(), solid.end());
  AddVertices(vertices, &mesh);
  AddPlanes(&mesh);
  AddNeighborsAndComponents(&mesh);
  AddRegions(&mesh);
  return mesh;
}

}  // namespace drake_haptics
