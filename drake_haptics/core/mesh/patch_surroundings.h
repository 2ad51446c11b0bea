#pragma once

#include <optional>
#include <span>
#include <vector>

#include "convex/polytope.h"
#include "mesh/decomposition.h"
#include "mesh/mesh_edges.h"

namespace drake_haptics {

/// The edges of a mesh at a vertex.
struct MeshRing {
  std::vector<Vec3> edges;    ///< unit directions, by the index of the far end
  std::vector<Vec3> corners;  ///< FindRingCorners of these
};

/// The triangles around the vertices and edges of a mesh, positions in m.
struct MeshTopology {
  MeshTopology(std::span<const Vec3> vertices,
               std::span<const Triangle> triangles);

  /// Triangles on the mesh edge between two vertices; empty if there is none.
  std::span<const TriangleSide> SidesOf(int a, int b) const;

  std::span<const int> triangles_at(int vertex) const {
    return {vertex_triangle.data() + vertex_triangle_start[vertex],
            vertex_triangle.data() + vertex_triangle_start[vertex + 1]};
  }

  /// The ring of a vertex, found once: many pieces share a vertex, and its
  /// corners take the cube of the number of its edges.
  const MeshRing& RingAt(int vertex);

  std::span<const Vec3> vertices;
  std::span<const Triangle> triangles;
  std::vector<TriangleSide> sides;  ///< sorted
  std::vector<int> vertex_triangle_start, vertex_triangle;
  std::vector<std::optional<MeshRing>> rings;  ///< those that were asked for
};

/// Marks the edges of a piece whose facets are marked, and sets its wings and
/// rings to those of the whole mesh, which continues beyond the piece.
/// @param patch triangles that the piece was made from.
/// @param source mesh vertex of each vertex of the piece.
/// @param tolerance distance, m, within which a mesh edge lies on an edge of
///     the piece.
void ConnectToSurface(std::span<const int> patch, std::span<const int> source,
                      double tolerance, MeshTopology* mesh, Polytope* piece);

/// Marks an edge as original exactly if a facet beside it is: original facets
/// are bounded by mesh edges. Virtual edges have no wings.
void MarkEdgesFromFacets(Polytope* piece);

}  // namespace drake_haptics
