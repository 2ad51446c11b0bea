#include "convex/gauss_angle_bound.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drake_haptics {
namespace {

// Cosine of the largest angle between n and the facets around a vertex.
double SmallestCosine(const Polytope& P, const Vec3& n, int vertex) {
  double cosine = 1;
  for (const Polytope::OneRingEntry& ring_entry : P.fan_of(vertex)) {
    cosine = std::min(cosine, n.dot(ring_entry.normal));
  }
  return cosine;
}

double EdgeTurn(const Polytope& P, const Polytope::Edge& edge) {
  if (edge.left < 0) return std::numeric_limits<double>::infinity();
  double cosine = 1;
  for (const int facet : {edge.left, edge.right}) {
    for (const int vertex : {edge.v0, edge.v1}) {
      cosine =
          std::min(cosine, SmallestCosine(P, P.facets[facet].normal, vertex));
    }
  }
  return GaussAngleBound(cosine);
}

}  // namespace

double GaussAngleBound(double cosine) {
  constexpr double kRightAngle = -1e-9;  // its cosine, with round-off
  if (cosine < kRightAngle) return std::numeric_limits<double>::infinity();
  const double c = std::clamp(cosine, 0.0, 1.0);
  return std::sqrt((1 - c) / (1 + c));
}

void FillGaussAngleBounds(Polytope* polytope) {
  Polytope& P = *polytope;
  P.facet_loop_side.clear();
  for (int f = 0; f < static_cast<int>(P.facets.size()); ++f) {
    const auto loop = P.loop_of(f);
    const Vec3& normal = P.facets[f].normal;
    double cosine = 1;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& p = P.vertices[loop[k]];
      const Vec3& q = P.vertices[loop[(k + 1) % loop.size()]];
      P.facet_loop_side.push_back((q - p).cross(normal).stableNormalized());
      cosine = std::min(cosine, SmallestCosine(P, normal, loop[k]));
    }
    P.facets[f].turn = GaussAngleBound(cosine);
  }
  for (Polytope::Edge& edge : P.edges) edge.turn = EdgeTurn(P, edge);
}

}  // namespace drake_haptics
