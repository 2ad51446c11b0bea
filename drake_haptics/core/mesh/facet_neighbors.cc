#include "mesh/facet_neighbors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/sort_unique.h"
#include "convex/normal_cone_support.h"
#include "mesh/mesh_edges.h"
#include "mesh/surface_mesh.h"

namespace drake_haptics {
namespace {

// A side of a facet of a piece.
struct FacetSide {
  int facet = -1;
  int side = -1;
};

class Search {
 public:
  explicit Search(const Decomposition& of)
      : vertices_(of.vertices),
        triangles_(of.triangles),
        pieces_(of.pieces),
        piece_of_triangle_(of.piece_of_triangle),
        // Twice the distance within which hull triangles are merged into a
        // facet.
        tolerance_(2 * kFacetTolerances *
                   SurfaceTolerance(of.vertices, of.triangles)) {}

  // Calls add(piece, facet, neighbor) for both facets at each edge.
  template <typename Add>
  void Run(const Add& add) const {
    const std::vector<TriangleSide> sides = SortedSides(triangles_);
    ForEachMeshEdge(sides, [&](std::span<const TriangleSide> at_edge) {
      if (at_edge.size() != 2 || at_edge[0].forward == at_edge[1].forward)
        return;
      const int p = piece_of_triangle_[at_edge[0].triangle];
      const int q = piece_of_triangle_[at_edge[1].triangle];
      if (p < 0 || q < 0 || p == q) return;
      const FacetSide of_p = FindSide(pieces_[p], at_edge[0]);
      const FacetSide of_q = FindSide(pieces_[q], at_edge[1]);
      if (of_p.side < 0 || of_q.side < 0) return;
      // Sine of the angle by which the facets rise above each other.
      const Polytope& Q = pieces_[q];
      const double rise = -pieces_[p].facets[of_p.facet].normal.dot(
          Q.facet_loop_side[Q.facet_loop_start[of_q.facet] + of_q.side]);
      if (rise < -kSurfaceSlack) return;
      const bool is_flush = rise <= kSurfaceSlack;
      add(p, of_p.facet,
          FacetNeighbor{of_p.side, q, of_q.facet, of_q.side, is_flush});
      add(q, of_q.facet,
          FacetNeighbor{of_q.side, p, of_p.facet, of_p.side, is_flush});
    });
  }

 private:
  FacetSide FindSide(const Polytope& P, const TriangleSide& side) const {
    const int facet = FindFacet(P, triangles_[side.triangle]);
    if (facet < 0) return {};
    const Vec3 &a = vertices_[side.low], &b = vertices_[side.high];
    const std::span<const int> loop = P.loop_of(facet);
    FacetSide found{facet, -1};
    double least = tolerance_;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& outward = P.facet_loop_side[P.facet_loop_start[facet] + k];
      const Vec3& on_side = P.vertices[loop[k]];
      const double off = std::max(std::abs(outward.dot(a - on_side)),
                                  std::abs(outward.dot(b - on_side)));
      if (off > least) continue;
      least = off;
      found.side = static_cast<int>(k);
    }
    return found;
  }

  // The facet on which a triangle of the piece lies, or -1.
  int FindFacet(const Polytope& P, const Triangle& triangle) const {
    const Vec3& a = vertices_[triangle[0]];
    const Vec3 area =
        (vertices_[triangle[1]] - a).cross(vertices_[triangle[2]] - a);
    int found = -1;
    double most = 0;
    for (std::size_t f = 0; f < P.facets.size(); ++f) {
      const Polytope::Facet& facet = P.facets[f];
      const double facing = facet.normal.dot(area);
      if (!facet.original || !(facing > most)) continue;
      const bool is_on =
          std::all_of(triangle.begin(), triangle.end(), [&](int v) {
            return std::abs(facet.normal.dot(vertices_[v]) - facet.offset) <=
                   tolerance_;
          });
      if (!is_on) continue;
      most = facing;
      found = static_cast<int>(f);
    }
    return found;
  }

  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
  std::span<const Polytope> pieces_;
  std::span<const int> piece_of_triangle_;
  double tolerance_;
};

}  // namespace

FacetNeighbors::FacetNeighbors(const Decomposition& decomposition) {
  if (decomposition.triangles.empty()) return;
  first_facet_.assign(1, 0);
  for (const Polytope& piece : decomposition.pieces) {
    first_facet_.push_back(first_facet_.back() +
                           static_cast<int>(piece.facets.size()));
  }
  std::vector<std::pair<int, FacetNeighbor>> found;
  Search(decomposition)
      .Run([&](int piece, int facet, const FacetNeighbor& neighbor) {
        found.emplace_back(PlaceOf(piece, facet), neighbor);
      });
  if (found.empty()) {
    first_facet_.clear();
    return;
  }
  // A side may be a chain of mesh edges, each of which adds the neighbor.
  SortUnique(&found);
  start_.assign(num_facets() + 1, 0);
  for (const auto& [place, neighbor] : found) {
    ++start_[place + 1];
    neighbors_.push_back(neighbor);
  }
  for (int i = 0; i < num_facets(); ++i) start_[i + 1] += start_[i];
}

}  // namespace drake_haptics
