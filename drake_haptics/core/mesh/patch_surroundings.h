#pragma once

#include <span>
#include <vector>

#include "convex/polytope.h"
#include "mesh/decomposition.h"
#include "mesh/mesh_edges.h"

namespace drake_haptics {

/// The mesh around its vertices and edges, in m.
struct MeshTopology {
  MeshTopology(std::span<const Vec3> vertices,
               std::span<const Triangle> triangles);

  /// Triangles on the mesh edge between two vertices; empty if there is none.
  std::span<const TriangleSide> SidesOf(int a, int b) const;

  std::span<const int> triangles_at(int vertex) const {
    return {vertex_triangle.data() + vertex_triangle_start[vertex],
            vertex_triangle.data() + vertex_triangle_start[vertex + 1]};
  }

  std::span<const Vec3> vertices;
  std::span<const Triangle> triangles;
  std::vector<TriangleSide> sides;  ///< sorted
  std::vector<int> vertex_triangle_start, vertex_triangle;
};

/// Marks the edges of a piece whose facets are marked, and sets its wings and
/// rings to those of the whole mesh, which goes on beyond the piece.
/// @param patch triangles that the piece was made from.
/// @param source mesh vertex of each vertex of the piece.
/// @param tolerance distance, m, within which a mesh edge lies on the piece's.
void ConnectToSurface(const MeshTopology& mesh, std::span<const int> patch,
                      std::span<const int> source, double tolerance,
                      Polytope* piece);

/// An edge is on the surface exactly when a facet beside it is: facets that
/// are original are bounded by mesh edges. Virtual edges have no wings.
void MarkEdgesFromFacets(Polytope* piece);

}  // namespace drake_haptics
