#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "convex/support.h"

/// Exact answers by enumeration, for tests: O(edges of A × edges of B).
namespace drake_haptics {

/// The gap h(n) = min n·a − max n·b over all vertices, without climbing.
inline double FullGap(const PosedPair& pair, const Vec3& n) {
  double a = std::numeric_limits<double>::infinity(), b = -a;
  for (int i = 0; i < pair.A.num_vertices(); ++i) {
    a = std::min(a, n.dot(pair.a(i)));
  }
  for (int j = 0; j < pair.B.num_vertices(); ++j) {
    b = std::max(b, n.dot(pair.b(j)));
  }
  return a - b;
}

/// The penetration depth (m): the least of −h(n) over the normals of all facets
/// and the cross products of all pairs of edges. Negative for a pair apart.
inline double EnumeratedDepth(const PosedPair& pair) {
  double depth = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vec3& n) {
    depth = std::min(depth, -FullGap(pair, n));
  };
  for (const auto& facet : pair.A.facets) consider(-facet.normal);
  for (const auto& facet : pair.B.facets) consider(pair.X_AB.R * facet.normal);
  for (const auto& edge_A : pair.A.edges) {
    const Vec3 along_A = pair.a(edge_A.v1) - pair.a(edge_A.v0);
    for (const auto& edge_B : pair.B.edges) {
      const Vec3 along_B = pair.b(edge_B.v1) - pair.b(edge_B.v0);
      const Vec3 cross = along_A.cross(along_B);
      if (!(cross.norm() > 1e-8 * along_A.norm() * along_B.norm())) continue;
      const Vec3 n = cross.normalized();
      // The plane through both edges bounds the support from below.
      const double h = n.dot(pair.a(edge_A.v0) - pair.b(edge_B.v0));
      if (-h < depth) consider(n);
      if (h < depth) consider(-n);
    }
  }
  return depth;
}

}  // namespace drake_haptics
