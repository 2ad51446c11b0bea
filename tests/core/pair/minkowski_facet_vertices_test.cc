// The vertex pairs of a flush facet against all pairs of vertices that it could
// have.
#include "pair/minkowski_facet_vertices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "check.h"

namespace drake_haptics {
namespace {

// A prism over a regular polygon, on z from 0 to 1.
Polytope Prism(int sides, double radius, double turn) {
  std::vector<Vec3> points;
  for (int k = 0; k < sides; ++k) {
    const double angle = turn + 2 * M_PI * k / sides;
    for (const double z : {0.0, 1.0}) {
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                          z);
    }
  }
  return MakePolytope(points);
}

int FacetFacing(const Polytope& P, const Vec3& outward) {
  for (std::size_t f = 0; f < P.facets.size(); ++f) {
    if (P.facets[f].normal.dot(outward) > 0.999) return static_cast<int>(f);
  }
  return -1;
}

// Whether the vertex pair is an extreme point of the difference in some
// direction of the plane: tried densely.
bool IsCorner(const PosedPair& pair, const MinkowskiVertex& vertex_pair,
              const std::vector<int>& loop_A, const std::vector<int>& loop_B) {
  for (int k = 0; k < 720; ++k) {
    const double angle = 2 * M_PI * (k + 0.37) / 720;
    const Vec3 d(std::cos(angle), std::sin(angle), 0);
    const bool is_A = std::all_of(loop_A.begin(), loop_A.end(), [&](int v) {
      return d.dot(pair.a(v)) <= d.dot(pair.a(vertex_pair.a)) + 1e-12;
    });
    const bool is_B = std::all_of(loop_B.begin(), loop_B.end(), [&](int v) {
      return d.dot(pair.b(v)) >= d.dot(pair.b(vertex_pair.b)) - 1e-12;
    });
    if (is_A && is_B) return true;
  }
  return false;
}

void TestFlushPrisms() {
  for (const auto& [m, n] : {std::pair{3, 4}, {5, 3}, {12, 7}}) {
    const Polytope A = Prism(m, 1.0, 0.1), B = Prism(n, 0.7, 0.53);
    Pose X_AB;
    X_AB.p = Vec3(0.2, -0.1, -0.9);  // B's top is 0.1 inside A's bottom.
    const PosedPair pair{A, B, X_AB};
    const Vec3 n_A = Vec3::UnitZ();  // from B into A
    const int bottom = FacetFacing(A, -n_A), top = FacetFacing(B, n_A);
    const auto span_A = A.loop_of(bottom), span_B = B.loop_of(top);
    const std::vector<int> loop_A(span_A.begin(), span_A.end());
    const std::vector<int> loop_B(span_B.begin(), span_B.end());
    // Known by a vertex and an edge alone.
    const Feature vertex(FeatureKind::kVertex, loop_A[0]);
    const Feature edge(FeatureKind::kEdge,
                       B.facet_loop_edge[B.facet_loop_start[top]]);
    CHECK(WidestSupport(A, vertex, -n_A) ==
          Feature(FeatureKind::kFacet, bottom));
    CHECK(WidestSupport(B, edge, n_A) == Feature(FeatureKind::kFacet, top));
    std::vector<MinkowskiVertex> vertex_pairs;
    ListMinkowskiFacetVertices(pair, vertex, edge, n_A, &vertex_pairs);
    CHECK(static_cast<int>(vertex_pairs.size()) == m + n);
    for (const int a : loop_A) {
      for (const int b : loop_B) {
        const MinkowskiVertex vertex_pair{a, b};
        const bool is_listed =
            std::find(vertex_pairs.begin(), vertex_pairs.end(), vertex_pair) !=
            vertex_pairs.end();
        CHECK(is_listed == IsCorner(pair, vertex_pair, loop_A, loop_B));
      }
    }
  }
}

void TestPointContactStaysAsItIs() {
  const Polytope A = Prism(6, 1.0, 0.0);
  const Vec3 slanted = Vec3(0.3, 0.2, 1.0).normalized();
  const int v = SupportVertex(A, slanted, 0);
  const Feature vertex(FeatureKind::kVertex, v);
  CHECK(WidestSupport(A, vertex, slanted) == vertex);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TestFlushPrisms();
  drake_haptics::TestPointContactStaysAsItIs();
  return drake_haptics::FailedChecks() > 0;
}
