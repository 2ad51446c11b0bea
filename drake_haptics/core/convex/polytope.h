#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/direction_cone.h"
#include "base/types.h"

namespace drake_haptics {

/// A convex polytope of dimension 0 to 3 with all its adjacency in contiguous
/// arrays. Immutable once built, so that any number of queries may share it.
///
/// A flat polytope (dimension 2) is a convex polygon with two facets: facet 0
/// is its front, facet 1 its back with the opposite normal. A segment
/// (dimension 1) has two vertices and one edge, a point one vertex.
///
/// "Surface" is what the polytope stands for. For a polytope on its own that is
/// its whole boundary. For a piece of a decomposed mesh it is the patch of the
/// mesh that the piece was made from: the features of the hull that are not on
/// the mesh are virtual (paper, 5.3.1), and the surface continues beyond the
/// piece in the directions of `ring` and `wings`.
struct Polytope {
  struct Edge {
    int v0 = -1, v1 = -1;       ///< end vertices
    int left = -1, right = -1;  ///< facets beside it; -1 on a segment
    bool original = true;       ///< lies on an edge of the surface
    /// In each surface face beside the edge, the unit direction that is
    /// perpendicular to the edge and points away from it. The surface is
    /// locally supported by direction n at the edge when n ⟂ edge and
    /// n · wing <= 0 for each wing. Zero vectors where there is no face.
    std::array<Vec3, 2> wings{Vec3::Zero(), Vec3::Zero()};
    /// Ends of the arc of outward directions along which the edge can carry a
    /// contact, up to half a turn apart, nearly unit; zero if it cannot
    /// (patch_normal_cone.h).
    std::array<Vec3, 2> normal_arc{Vec3::Zero(), Vec3::Zero()};
    double turn = 0;  ///< see gauss_angle_bound.h
  };

  struct Facet {
    Vec3 normal = Vec3::Zero();  ///< unit, outward
    double offset = 0;           ///< normal · x = offset on the facet, m
    bool original = true;        ///< lies on the surface
    double turn = 0;             ///< see gauss_angle_bound.h
  };

  /// An edge at a vertex and the facet that follows it, with copies of the data
  /// that a search reads, so that it reads contiguous memory around a vertex.
  struct OneRingEntry {
    Vec3 along = Vec3::Zero();   ///< from the vertex to its neighbor, m
    Vec3 normal = Vec3::Zero();  ///< facet's normal; zero on a segment
    int neighbor = -1;           ///< vertex at the edge's other end
    int edge = -1;
    int facet = -1;  ///< -1 on a segment
  };

  /// An edge of the exact hull of the vertices that lies inside a facet.
  struct HiddenEdge {
    Vec3 along = Vec3::Zero();  ///< from the vertex to its neighbor, m
    int neighbor = -1;
  };

  int dimension = 0;
  std::vector<Vec3> vertices;  ///< extreme points only
  std::vector<Edge> edges;
  std::vector<Facet> facets;

  /// Vertex loops of the facets, counter-clockwise seen from outside.
  std::vector<int> facet_loop_start{0};
  std::vector<int> facet_loop;
  /// Edge k of facet f's loop joins loop vertices k and k + 1.
  std::vector<int> facet_loop_edge;
  /// Unit normal of edge k in the facet's plane, out of the facet.
  std::vector<Vec3> facet_loop_side;

  /// The edges and facets around each vertex, counter-clockwise seen from
  /// outside: a facet lies between its ring entry's edge and the next one's.
  std::vector<int> fan_start{0};
  std::vector<OneRingEntry> fan;

  /// Edges at each vertex inside facets that are flat only within the tolerance
  /// (hidden_edges.h); both empty if all facets are flat.
  std::vector<int> hidden_start;
  std::vector<HiddenEdge> hidden;

  /// Unit directions from each vertex along all edges of the surface there.
  /// The surface is locally supported by n at the vertex when n · r <= 0 for
  /// each r of its ring.
  std::vector<int> ring_start{0};
  std::vector<Vec3> ring;

  /// Contains all outward directions along which the surface can carry a
  /// contact (patch_normal_cone.h).
  DirectionCone normal_cone;

  Vec3 centroid = Vec3::Zero();  ///< mean of the vertices
  double radius = 0;  ///< radius of the bounding ball about the centroid, m
  double inner_radius =
      0;  ///< of a ball about the centroid that it contains, m
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< corners of the box, m

  int num_vertices() const { return static_cast<int>(vertices.size()); }

  int first_vertex_of(Feature feature) const {
    switch (feature.kind()) {
      case FeatureKind::kVertex:
        return feature.index();
      case FeatureKind::kEdge:
        return edges[feature.index()].v0;
      default:
        return loop_of(feature.index())[0];
    }
  }
  std::span<const OneRingEntry> fan_of(int v) const {
    return {fan.data() + fan_start[v], fan.data() + fan_start[v + 1]};
  }
  std::span<const HiddenEdge> hidden_of(int v) const {
    if (hidden_start.empty()) return {};
    return {hidden.data() + hidden_start[v],
            hidden.data() + hidden_start[v + 1]};
  }
  std::span<const Vec3> ring_of(int v) const {
    return {ring.data() + ring_start[v], ring.data() + ring_start[v + 1]};
  }
  std::span<const int> loop_of(int f) const {
    return {facet_loop.data() + facet_loop_start[f],
            facet_loop.data() + facet_loop_start[f + 1]};
  }
};

/// Builds the convex hull of `points` (one or more, any dimension, duplicates
/// and inner points allowed) as a polytope on its own: every feature original,
/// rings and wings along its own edges and facets. Coplanar triangles are
/// merged into one facet, collinear and inner points are dropped. A set whose
/// thickness is below `flatness` times its size is flattened.
/// @param points positions, m; their order determines the order of the result.
/// @throws std::invalid_argument if empty, or not finite and below 1e50 m.
Polytope MakePolytope(std::span<const Vec3> points, double flatness = 1e-12);

}  // namespace drake_haptics
