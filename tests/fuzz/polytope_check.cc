#include "polytope_check.h"

#include <algorithm>

#include "convex/support.h"
#include "draw.h"

namespace drake_haptics::fuzz {
namespace {

constexpr int kHullProbes = 4;

bool IsWithin(std::span<const int> indices, int low, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(), [&](int i) {
    return i >= low && i < static_cast<int>(count);
  });
}

bool HasValidIndices(const Polytope& P) {
  for (const Polytope::Edge& edge : P.edges) {
    const int ends[] = {edge.v0, edge.v1}, sides[] = {edge.left, edge.right};
    if (!IsWithin(ends, 0, P.vertices.size()) ||
        !IsWithin(sides, P.dimension < 2 ? -1 : 0, P.facets.size())) {
      return false;
    }
  }
  return IsWithin(P.facet_loop, 0, P.vertices.size()) &&
         IsWithin(P.facet_loop_edge, 0, P.edges.size());
}

}  // namespace

void CheckPolytope(const Polytope& P, std::span<const Vec3> points,
                   double tolerance, ByteSource* probes, Tally* tally) {
  if (!HasValidIndices(P)) {
    tally->Violated("indices of a hull", "%zu vertices", P.vertices.size());
    return;
  }
  const std::size_t euler =
      P.vertices.size() + P.facets.size() - P.edges.size();
  if (P.dimension >= 2 && euler != 2) {
    tally->Violated("Euler's formula", "%zu vertices, V - E + F = %zu",
                    P.vertices.size(), euler);
  }
  double above = 0;
  for (const Polytope::Facet& facet : P.facets) {
    if (!(std::abs(facet.normal.norm() - 1) < 1e-12)) {
      tally->Violated("unit facet normal", "%g off", facet.normal.norm() - 1);
    }
    for (const Vec3& p : points) {
      above = std::max(above, facet.normal.dot(p) - facet.offset);
    }
  }
  if (!(above <= tolerance)) {
    tally->Violated("points behind facets", "%g above, radius %g", above,
                    P.radius);
  }
  for (int i = 0; i < kHullProbes; ++i) {
    const Vec3 n = DrawDirection(probes);
    const int start = probes->Byte() % P.num_vertices();
    const double climbed = n.dot(P.vertices[SupportVertex(P, n, start)]);
    for (const Vec3& p : points) {
      if (n.dot(p) <= climbed + tolerance) continue;
      tally->Violated("climbed support", "%g too low, radius %g",
                      n.dot(p) - climbed, P.radius);
      break;
    }
  }
}

}  // namespace drake_haptics::fuzz
