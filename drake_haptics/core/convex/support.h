#pragma once

#include <algorithm>
#include <cmath>

#include "base/types.h"
#include "convex/polytope.h"

namespace drake_haptics {

/// The vertex of `polytope` that is farthest along `direction` (any length, in
/// the polytope's frame). Climbs from vertex `start`, fan by fan: under
/// coherent motion it reads one fan, whatever the size.
[[nodiscard]] int SupportVertex(const Polytope& polytope, const Vec3& direction,
                                int start);

/// Rise, m, that the flatness tolerance of a facet allows to an edge hidden in
/// it at vertex v: out of the facet's plane and, where two corners nearly
/// coincide, beside its edges.
inline double Unevenness(const Polytope& P, int v,
                         const Polytope::HiddenEdge& edge) {
  double least = edge.along.norm();
  for (const auto& ring_entry : P.fan_of(v)) {
    least = std::min(least, std::abs(ring_entry.normal.dot(edge.along)));
  }
  constexpr double kTolerance = 1e-6;  // flatness, as a share of the size
  return std::max(2 * least, kTolerance * P.radius);
}

/// Whether no neighbor of vertex v is farther than v along the unit direction,
/// in the polytope's frame, by more than the slack (m). A neighbor across a
/// facet may also be farther by the unevenness of the facet.
[[nodiscard]] inline bool IsFarthest(const Polytope& P, int v,
                                     const Vec3& direction, double slack) {
  for (const auto& ring_entry : P.fan_of(v)) {
    if (direction.dot(ring_entry.along) > slack) return false;
  }
  for (const auto& edge : P.hidden_of(v)) {
    const double beyond = direction.dot(edge.along) - slack;
    if (beyond > 0 && beyond > Unevenness(P, v, edge)) return false;
  }
  return true;
}

/// Two polytopes in A's frame: A as it is, B posed by X_AB. The difference of
/// the origins is formed once, in X_AB, so that common offsets in the world
/// cost no precision.
struct PosedPair {
  const Polytope& A;
  const Polytope& B;
  Pose X_AB;

  Vec3 a(int i) const { return A.vertices[i]; }
  Vec3 b(int j) const { return X_AB * B.vertices[j]; }
  /// Length to which round-off is compared, m.
  double scale() const { return A.radius + B.radius; }
};

/// A vertex pair that supports the pair along a direction from B into A.
struct MinkowskiVertex {
  int a = 0;
  int b = 0;
  bool operator==(const MinkowskiVertex&) const = default;
};

/// Moves `vertex_pair` to the vertices that face each other along n (in A's
/// frame, from B into A) and returns the support gap h(n) = min n·a − max n·b.
/// For unit n the signed distance is at least h(n).
double SupportGap(const PosedPair& pair, const Vec3& n,
                  MinkowskiVertex* vertex_pair);

}  // namespace drake_haptics
