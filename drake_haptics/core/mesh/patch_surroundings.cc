#include "mesh/patch_surroundings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "convex/patch_normal_cone.h"

namespace drake_haptics {
namespace {

// Sets the outer wings of a piece from the mesh around it.
class SurfaceAround {
 public:
  SurfaceAround(const MeshTopology& mesh, std::span<const int> patch,
                std::span<const int> source, double tolerance, Polytope* piece)
      : mesh_(mesh),
        patch_(patch),
        source_(source),
        tolerance_(tolerance),
        piece_(*piece) {}

  // The mesh continues beyond an edge with one original facet.
  void SetOuterWings() {
    for (Polytope::Edge& edge : piece_.edges) {
      if (edge.left < 0) continue;
      const bool left = piece_.facets[edge.left].original;
      const bool right = piece_.facets[edge.right].original;
      if (left == right) continue;
      edge.wings[left ? 1 : 0] =
          OuterWing(edge, piece_.facets[left ? edge.left : edge.right].normal);
    }
  }

 private:
  // Direction in a mesh triangle away from the piece's edge, perpendicular to
  // it.
  Vec3 WingOf(int triangle, const Polytope::Edge& edge) const {
    const Vec3& base = piece_.vertices[edge.v0];
    const Vec3 along = (piece_.vertices[edge.v1] - base).stableNormalized();
    Vec3 best = Vec3::Zero();
    for (const int v : mesh_.triangles[triangle]) {
      const Vec3 from_base = mesh_.vertices[v] - base;
      const Vec3 away = from_base - along * along.dot(from_base);
      if (away.squaredNorm() > best.squaredNorm()) best = away;
    }
    return best.isZero(0) ? best : Vec3(best.stableNormalized());
  }

  bool InPatch(int triangle) const {
    return std::binary_search(patch_.begin(), patch_.end(), triangle);
  }

  // Wing in the mesh face beyond the edge that rises most above the facet: it
  // leaves the fewest directions in which the surface is supported.
  Vec3 OuterWing(const Polytope::Edge& edge, const Vec3& facet_normal) const {
    Vec3 best = Vec3::Zero();
    const auto consider = [&](std::span<const TriangleSide> sides) {
      for (const TriangleSide& side : sides) {
        if (InPatch(side.triangle)) continue;
        const Vec3 wing = WingOf(side.triangle, edge);
        if (wing.isZero(0)) continue;
        if (best.isZero(0) || wing.dot(facet_normal) > best.dot(facet_normal)) {
          best = wing;
        }
      }
    };
    const auto sides = mesh_.SidesOf(source_[edge.v0], source_[edge.v1]);
    if (!sides.empty()) {
      consider(sides);
      return best;
    }
    // The edge is a chain of collinear mesh edges of the patch.
    for (const int t : patch_) {
      const Triangle& triangle = mesh_.triangles[t];
      for (int k = 0; k < 3; ++k) {
        const int a = triangle[k], b = triangle[(k + 1) % 3];
        if (LiesOn(edge, a) && LiesOn(edge, b)) consider(mesh_.SidesOf(a, b));
      }
    }
    return best;
  }

  bool LiesOn(const Polytope::Edge& edge, int vertex) const {
    const Vec3& base = piece_.vertices[edge.v0];
    const Vec3 span = piece_.vertices[edge.v1] - base;
    const Vec3 from_base = mesh_.vertices[vertex] - base;
    const double length = span.stableNorm();
    const double along = span.dot(from_base) / length;
    return span.cross(from_base).norm() <= tolerance_ * length &&
           along >= -tolerance_ && along <= length + tolerance_;
  }

  const MeshTopology& mesh_;
  std::span<const int> patch_;
  std::span<const int> source_;
  double tolerance_;
  Polytope& piece_;
};

}  // namespace

MeshTopology::MeshTopology(std::span<const Vec3> vertices_in,
                           std::span<const Triangle> triangles_in)
    : vertices(vertices_in),
      triangles(triangles_in),
      sides(SortedSides(triangles_in)),
      vertex_triangle_start(vertices_in.size() + 1, 0),
      vertex_triangle(3 * triangles_in.size()),
      rings(vertices_in.size()) {
  for (const Triangle& t : triangles) {
    for (const int v : t) ++vertex_triangle_start[v + 1];
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    vertex_triangle_start[v + 1] += vertex_triangle_start[v];
  }
  std::vector<int> next = vertex_triangle_start;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t]) {
      vertex_triangle[next[v]++] = static_cast<int>(t);
    }
  }
}

std::span<const TriangleSide> MeshTopology::SidesOf(int a, int b) const {
  const auto [low, high] = std::minmax(a, b);
  const auto before = [](const TriangleSide& s, const TriangleSide& t) {
    return std::tie(s.low, s.high) < std::tie(t.low, t.high);
  };
  const TriangleSide wanted{low, high, 0, 0, true};
  const auto [first, last] =
      std::equal_range(sides.begin(), sides.end(), wanted, before);
  return {first, last};
}

const MeshRing& MeshTopology::RingAt(int vertex) {
  std::optional<MeshRing>& ring = rings[vertex];
  if (ring) return *ring;
  ring.emplace();
  for (const int w : VerticesOf(triangles, triangles_at(vertex))) {
    const Vec3 along = vertices[w] - vertices[vertex];
    if (!along.isZero(0)) ring->edges.push_back(along.stableNormalized());
  }
  ring->corners = FindRingCorners(ring->edges);
  return *ring;
}

void ConnectToSurface(std::span<const int> patch, std::span<const int> source,
                      double tolerance, MeshTopology* mesh, Polytope* piece) {
  MarkEdgesFromFacets(piece);
  SurfaceAround(*mesh, patch, source, tolerance, piece).SetOuterWings();
  piece->ring_start.assign(1, 0);
  piece->ring.clear();
  std::vector<std::span<const Vec3>> corners;
  for (const int v : source) {
    const MeshRing& ring = mesh->RingAt(v);
    piece->ring.insert(piece->ring.end(), ring.edges.begin(), ring.edges.end());
    piece->ring_start.push_back(static_cast<int>(piece->ring.size()));
    corners.push_back(ring.corners);
  }
  FillEdgeNormalArcs(piece);
  piece->normal_cone = FindPatchNormalCone(*piece, corners);
}

void MarkEdgesFromFacets(Polytope* piece) {
  for (Polytope::Edge& edge : piece->edges) {
    if (edge.left < 0) continue;
    const bool left = piece->facets[edge.left].original;
    const bool right = piece->facets[edge.right].original;
    edge.original = left || right;
    if (edge.original) continue;
    edge.wings = edge.normal_arc = {Vec3::Zero(), Vec3::Zero()};
  }
}

}  // namespace drake_haptics
