#include "convex/normal_cone_support.h"

#include <algorithm>
#include <cassert>
#include <span>

namespace drake_haptics {
namespace {

int FindEdge(const Polytope& polytope, int v0, int v1) {
  for (const Polytope::OneRingEntry& ring_entry : polytope.fan_of(v0)) {
    if (ring_entry.neighbor == v1) return ring_entry.edge;
  }
  return -1;
}

bool FacetHolds(const Polytope& polytope, int facet, int vertex) {
  const auto loop = polytope.loop_of(facet);
  return std::find(loop.begin(), loop.end(), vertex) != loop.end();
}

// Whether some directions of a surface fall away from n and none rises, so that
// n points out of a convex part.
bool FallsAway(std::span<const Vec3> directions, const Vec3& n) {
  const auto rises = [&](const Vec3& r) { return n.dot(r) > kSurfaceSlack; };
  const auto falls = [&](const Vec3& r) { return n.dot(r) < -kSurfaceSlack; };
  return std::none_of(directions.begin(), directions.end(), rises) &&
         std::any_of(directions.begin(), directions.end(), falls);
}

// Whether the surface is convex at an edge. Between original facets a piece is
// convex; elsewhere one face must fall away from the other.
bool IsConvex(const Polytope& polytope, const Polytope::Edge& edge) {
  if (!edge.original || edge.left < 0 || edge.right < 0) return false;
  if (polytope.facets[edge.left].original &&
      polytope.facets[edge.right].original) {
    return true;
  }
  const Vec3 along = polytope.vertices[edge.v1] - polytope.vertices[edge.v0];
  return !edge.wings[0].isZero(0) && !edge.wings[1].isZero(0) &&
         along.cross(edge.wings[0]).dot(edge.wings[1]) < 0;
}

// Whether n leaves the solid at an edge of the mesh: seen from inside, a
// concave edge is a ridge like any other. The wings give the normals of the
// mesh faces beside the edge. At the rim of an open mesh, n may lie in the only
// face. Out of a blade, n lies nearly in both faces.
bool LeavesEdge(const Polytope& polytope, const Polytope::Edge& edge,
                const Vec3& n) {
  const Vec3 along = polytope.vertices[edge.v1] - polytope.vertices[edge.v0];
  const bool is_rim = edge.wings[0].isZero(0) || edge.wings[1].isZero(0);
  const double least = (is_rim ? -kSurfaceSlack : kSurfaceSlack) * along.norm();
  const auto leaves = [&](const Vec3& wing, const Vec3& normal) {
    return !wing.isZero(0) && n.dot(normal) > least;
  };
  return edge.left < 0 || leaves(edge.wings[0], along.cross(edge.wings[0])) ||
         leaves(edge.wings[1], edge.wings[1].cross(along)) ||
         (IsConvex(polytope, edge) && FallsAway(edge.wings, n));
}

// Whether n leaves a vertex at the edge of a blade, or at the tip of a needle.
bool LeavesTip(const Polytope& polytope, int vertex, const Vec3& n) {
  if (!FallsAway(polytope.ring_of(vertex), n)) return false;
  const auto fan = polytope.fan_of(vertex);
  const auto is_on_surface = [&](const Polytope::OneRingEntry& ring_entry) {
    return ring_entry.facet >= 0 && polytope.facets[ring_entry.facet].original;
  };
  const auto is_of_blade = [&](const Polytope::OneRingEntry& ring_entry) {
    if (ring_entry.edge < 0) return false;
    const Polytope::Edge& edge = polytope.edges[ring_entry.edge];
    return IsConvex(polytope, edge) && FallsAway(edge.wings, n);
  };
  return std::all_of(fan.begin(), fan.end(), is_on_surface) ||
         std::any_of(fan.begin(), fan.end(), is_of_blade);
}

// Whether n leaves the solid at a vertex, by the piece's faces there. A
// direction along the faces does not, except at the rim of an open mesh and at
// a tip.
bool LeavesVertex(const Polytope& polytope, int vertex, const Vec3& n) {
  bool has_surface = false;
  bool is_rim = false;
  double most = -1;
  for (const Polytope::OneRingEntry& ring_entry : polytope.fan_of(vertex)) {
    if (ring_entry.edge >= 0) {
      const Polytope::Edge& edge = polytope.edges[ring_entry.edge];
      is_rim |=
          edge.original && (edge.wings[0].isZero(0) || edge.wings[1].isZero(0));
    }
    if (ring_entry.facet < 0 || !polytope.facets[ring_entry.facet].original)
      continue;
    most = std::max(most, n.dot(ring_entry.normal));
    has_surface = true;
  }
  return !has_surface || most > (is_rim ? -kSurfaceSlack : kSurfaceSlack) ||
         LeavesTip(polytope, vertex, n);
}

// Support of one side; n points out of the polytope, in its frame.
NormalConeSupport ClassifySide(const Polytope& polytope, Feature feature,
                               const Vec3& n) {
  const auto supported_if = [](bool condition) {
    return condition ? NormalConeSupport::kSupported
                     : NormalConeSupport::kOriginal;
  };
  switch (feature.kind()) {
    case FeatureKind::kFacet:
      return polytope.facets[feature.index()].original
                 ? NormalConeSupport::kSupported
                 : NormalConeSupport::kVirtual;
    case FeatureKind::kEdge: {
      const Polytope::Edge& edge = polytope.edges[feature.index()];
      if (!edge.original || !LeavesEdge(polytope, edge, n)) {
        return NormalConeSupport::kVirtual;
      }
      return supported_if(n.dot(edge.wings[0]) <= kSurfaceSlack &&
                          n.dot(edge.wings[1]) <= kSurfaceSlack);
    }
    default: {
      // Vertices are never created by a decomposition: all are original.
      if (!LeavesVertex(polytope, feature.index(), n)) {
        return NormalConeSupport::kVirtual;
      }
      const auto ring = polytope.ring_of(feature.index());
      return supported_if(std::all_of(
          ring.begin(), ring.end(),
          [&](const Vec3& r) { return n.dot(r) <= kSurfaceSlack; }));
    }
  }
}

}  // namespace

NormalConeSupport ClassifySupport(const Polytope& A, Feature feature_A,
                                  const Vec3& n_A, const Polytope& B,
                                  Feature feature_B, const Vec3& n_B) {
  const NormalConeSupport of_A = ClassifySide(A, feature_A, -n_A);
  if (of_A == NormalConeSupport::kVirtual) return of_A;
  return std::min(of_A, ClassifySide(B, feature_B, n_B));
}

Feature FeatureOfVertices(const Polytope& polytope, const int* vertices,
                          int count, const Vec3& n) {
  assert(count >= 1 && count <= 4);
  int distinct[4] = {};
  int size = 0;
  for (int i = 0; i < count; ++i) {
    if (std::find(distinct, distinct + size, vertices[i]) == distinct + size) {
      distinct[size++] = vertices[i];
    }
  }
  if (size == 1) return {FeatureKind::kVertex, distinct[0]};
  if (size == 2) {
    const int edge = FindEdge(polytope, distinct[0], distinct[1]);
    if (edge >= 0) return {FeatureKind::kEdge, edge};
  }
  Feature best(FeatureKind::kVertex, distinct[0]);
  double best_facing = -2;
  for (const Polytope::OneRingEntry& ring_entry :
       polytope.fan_of(distinct[0])) {
    const double facing = n.dot(ring_entry.normal);
    if (ring_entry.facet >= 0 && facing > best_facing &&
        std::all_of(distinct + 1, distinct + size, [&](int v) {
          return FacetHolds(polytope, ring_entry.facet, v);
        })) {
      best_facing = facing;
      best = {FeatureKind::kFacet, ring_entry.facet};
    }
  }
  return best;
}

}  // namespace drake_haptics
