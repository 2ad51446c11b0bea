#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "box_tree.h"
#include "convex_clip.h"
#include "decomposition.h"
#include "decomposition_input.h"
#include "surface_provenance.h"

namespace drake_haptics {
namespace {

// Share of a facet that the mesh must cover for the facet to be original.
constexpr double kCoveredShare = 0.99;

// The prism about a facet: its sides, and the slab of +- tolerance.
std::vector<Plane> FacetPrism(const Polytope& P, int f, double tolerance) {
  const Polytope::Facet& facet = P.facets[f];
  std::vector<Plane> planes{{facet.normal, facet.offset + tolerance},
                            {-facet.normal, -facet.offset + tolerance}};
  const auto loop = P.loop_of(f);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& a = P.vertices[loop[k]];
    const Vec3 along = P.vertices[loop[(k + 1) % loop.size()]] - a;
    const Vec3 outward = along.cross(facet.normal).stableNormalized();
    planes.push_back({outward, outward.dot(a)});
  }
  return planes;
}

void MarkNearMesh(std::span<const Vec3> vertices,
                  std::span<const Triangle> triangles, const BoxTree& tree,
                  double tolerance, Polytope* piece) {
  for (std::size_t f = 0; f < piece->facets.size(); ++f) {
    Polytope::Facet& facet = piece->facets[f];
    const int index = static_cast<int>(f);
    const std::vector<Plane> prism = FacetPrism(*piece, index, tolerance);
    BoxTree::Box box;
    std::vector<Vec3> polygon;
    for (const int v : piece->loop_of(index)) {
      polygon.push_back(piece->vertices[v]);
      box.extend(polygon.back() + Vec3::Constant(tolerance));
      box.extend(polygon.back() - Vec3::Constant(tolerance));
    }
    double covered = 0;
    tree.AnyOverlap(box, [&](int t) {
      const Vec3 &a = vertices[triangles[t][0]], &b = vertices[triangles[t][1]],
                 &c = vertices[triangles[t][2]];
      if ((b - a).cross(c - a).dot(facet.normal) > 0) {
        covered += PolygonArea(ClipPolygon({a, b, c}, prism, 0));
      }
      return false;
    });
    facet.original = covered >= kCoveredShare * PolygonArea(polygon);
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
  std::vector<BoxTree::Box> boxes;
  for (const Triangle& t : triangles) {
    BoxTree::Box& box = boxes.emplace_back();
    for (const int v : t) box.extend(vertices[v]);
  }
  const BoxTree tree(std::move(boxes));
  Decomposition result;
  result.vertices.assign(vertices.begin(), vertices.end());
  result.triangles.assign(triangles.begin(), triangles.end());
  result.piece_of_triangle.assign(triangles.size(), -1);
  for (const std::vector<Vec3>& points : pieces) {
    Polytope piece = MakePolytope(points);
    MarkNearMesh(vertices, triangles, tree, tolerance, &piece);
    MarkEdgesFromFacets(&piece);
    result.pieces.push_back(std::move(piece));
  }
  return result;
}

}  // namespace drake_haptics
