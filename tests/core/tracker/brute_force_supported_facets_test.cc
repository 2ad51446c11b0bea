// The facets that both surfaces carry against the enumeration of all features.
#include "tracker/brute_force_supported_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "check.h"
#include "minkowski_facets.h"

namespace drake_haptics {
namespace {

std::mt19937 random_bits(3);

Vec3 Gaussian() {
  std::normal_distribution<double> normal;
  return {normal(random_bits), normal(random_bits), normal(random_bits)};
}

// A polytope of which a part is no surface.
Polytope Piece(int size, bool is_flat) {
  std::vector<Vec3> points;
  for (int i = 0; i < size; ++i) {
    points.push_back(0.05 * Gaussian());
    if (is_flat) points.back().z() = 0;
  }
  Polytope piece = MakePolytope(points);
  std::bernoulli_distribution is_original(0.5);
  for (auto& facet : piece.facets) facet.original = is_original(random_bits);
  for (auto& edge : piece.edges) edge.original = is_original(random_bits);
  return piece;
}

bool IsInNormalCone(const PosedPair& pair, Feature a, Feature b,
                    const Vec3& n) {
  return ClassifySupport(pair.A, a, n, pair.B, b,
                         pair.X_AB.R.transpose() * n) ==
         NormalConeSupport::kSupported;
}

// The largest gap of all carried facets, by support over all vertices.
double EnumeratedGap(const PosedPair& pair) {
  constexpr double kSame = 1e-12;
  double best = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vec3& n, Feature a, Feature b, double h) {
    if (h > best && std::abs(h - FullGap(pair, n)) < kSame &&
        IsInNormalCone(pair, a, b, n)) {
      best = h;
    }
  };
  const auto vertex = [](int i) { return Feature(FeatureKind::kVertex, i); };
  for (int f = 0; f < static_cast<int>(pair.A.facets.size()); ++f) {
    const Vec3 n = -pair.A.facets[f].normal;
    for (int j = 0; j < pair.B.num_vertices(); ++j) {
      consider(n, {FeatureKind::kFacet, f}, vertex(j),
               n.dot(pair.a(pair.A.loop_of(f)[0]) - pair.b(j)));
    }
  }
  for (int f = 0; f < static_cast<int>(pair.B.facets.size()); ++f) {
    const Vec3 n = pair.X_AB.R * pair.B.facets[f].normal;
    for (int i = 0; i < pair.A.num_vertices(); ++i) {
      consider(n, vertex(i), {FeatureKind::kFacet, f},
               n.dot(pair.a(i) - pair.b(pair.B.loop_of(f)[0])));
    }
  }
  for (int i = 0; i < static_cast<int>(pair.A.edges.size()); ++i) {
    const auto& e = pair.A.edges[i];
    for (int j = 0; j < static_cast<int>(pair.B.edges.size()); ++j) {
      const auto& g = pair.B.edges[j];
      const Vec3 cross = (pair.a(e.v1) - pair.a(e.v0))
                             .cross(pair.b(g.v1) - pair.b(g.v0))
                             .normalized();
      for (const Vec3& n : {cross, Vec3(-cross)}) {
        consider(n, {FeatureKind::kEdge, i}, {FeatureKind::kEdge, j},
                 n.dot(pair.a(e.v0) - pair.b(g.v0)));
      }
    }
  }
  return best;
}

void TestNoneIsMissed() {
  int found = 0;
  for (int k = 0; k < 400; ++k) {
    const Polytope A = Piece(10, k % 3 == 0), B = Piece(9, k % 5 == 0);
    const Pose X_AB{
        Eigen::AngleAxisd(Gaussian().norm(), Gaussian().normalized())
            .toRotationMatrix(),
        0.02 * Gaussian()};
    const PosedPair pair{A, B, X_AB};
    const double best = EnumeratedGap(pair);
    std::vector<DepthCandidate> facets;
    ListSupportedFacetsByBruteForce(
        pair, -std::numeric_limits<double>::infinity(), &facets);
    CHECK(facets.empty() == std::isinf(best));
    if (facets.empty()) continue;
    ++found;
    CHECK(std::abs(facets[0].h - best) < 1e-12);
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const auto& f = facets[i];
      CHECK(i == 0 || f.h <= facets[i - 1].h);
      CHECK(std::abs(f.h - FullGap(pair, f.n)) < 1e-12);
      CHECK(IsInNormalCone(pair, f.feature_A, f.feature_B, f.n));
    }
    const std::size_t all = facets.size();
    const double floor = facets[all / 2].h;
    ListSupportedFacetsByBruteForce(pair, floor, &facets);
    CHECK(facets.size() <= all / 2);
    CHECK(facets.empty() || facets.back().h > floor);
  }
  CHECK(found > 300);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TestNoneIsMissed();
  return drake_haptics::FailedChecks() > 0;
}
