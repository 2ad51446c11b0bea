#include "convex/hidden_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/sort_unique.h"
#include "convex/affine_basis.h"
#include "convex/convex_hull.h"
#include "convex/predicates.h"

namespace drake_haptics {
namespace {

// Distance due to round-off between the corners of a flat facet and its plane,
// as a share of the coordinates.
constexpr double kRoundOff = 1e-13;

bool IsFlat(const Polytope& P, int f, double round_off) {
  const Polytope::Facet& facet = P.facets[f];
  const auto loop = P.loop_of(f);
  return std::all_of(loop.begin(), loop.end(), [&](int v) {
    return facet.offset - facet.normal.dot(P.vertices[v]) <= round_off;
  });
}

bool AreAllFlat(const Polytope& P, double round_off) {
  for (int f = 0; f < static_cast<int>(P.facets.size()); ++f) {
    if (P.loop_of(f).size() > 3 && !IsFlat(P, f, round_off)) return false;
  }
  return true;
}

// The corner of the adjacent triangle that faces edge k.
int CornerAcross(const std::vector<HullTriangle>& triangles,
                 const HullTriangle& triangle, int k) {
  for (const int v : triangles[triangle.neighbor[k]].vertex) {
    if (v != triangle.vertex[k] && v != triangle.vertex[(k + 1) % 3]) return v;
  }
  return triangle.vertex[k];
}

bool IsJoined(const Polytope& P, int v, int other) {
  const auto fan = P.fan_of(v);
  return std::any_of(fan.begin(), fan.end(), [&](const auto& ring_entry) {
    return ring_entry.neighbor == other;
  });
}

}  // namespace

void FillHiddenEdges(Polytope* P) {
  if (P->dimension < 3) return;
  double magnitude = 0;
  for (const Vec3& v : P->vertices) {
    magnitude = std::max(magnitude, v.cwiseAbs().maxCoeff());
  }
  if (AreAllFlat(*P, kRoundOff * magnitude)) return;
  const double scale = PowerOfTwoScale(magnitude);
  std::vector<Vec3> points;
  for (const Vec3& v : P->vertices) {
    points.push_back(NormalizeForPredicates(v, scale));
  }
  const AffineBasis basis = FindAffineBasis(points, kRoundOff);
  if (basis.dimension < 3) return;
  const std::vector<HullTriangle> triangles =
      ConvexHull(points, basis.point).Triangles();
  std::vector<std::array<int, 2>> ends;
  for (const HullTriangle& triangle : triangles) {
    for (int k = 0; k < 3; ++k) {
      const int from = triangle.vertex[k], to = triangle.vertex[(k + 1) % 3];
      const Vec3& across = points[CornerAcross(triangles, triangle, k)];
      const double drop = triangle.normal.dot(points[from] - across);
      if (drop > kRoundOff && !IsJoined(*P, from, to)) {
        ends.push_back({from, to});
        ends.push_back({to, from});
      }
    }
  }
  SortUnique(&ends);
  if (ends.empty()) return;
  P->hidden_start.assign(P->vertices.size() + 1, 0);
  for (const auto& [from, to] : ends) {
    ++P->hidden_start[from + 1];
    P->hidden.push_back({P->vertices[to] - P->vertices[from], to});
  }
  for (std::size_t v = 1; v < P->hidden_start.size(); ++v) {
    P->hidden_start[v] += P->hidden_start[v - 1];
  }
}

}  // namespace drake_haptics
