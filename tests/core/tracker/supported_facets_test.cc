// The facets that both surfaces carry, found along arcs of directions, against
// those of all pairs of features.
#include "tracker/supported_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "check.h"
#include "convex/normal_cone_support.h"
#include "mesh/decomposition.h"
#include "pair/witness.h"
#include "tracker/brute_force_supported_facets.h"

namespace drake_haptics {
namespace {

std::mt19937 generator(1);

double Uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

Vec3 RandomDirection() {
  std::normal_distribution<double> normal;
  return Vec3(normal(generator), normal(generator), normal(generator))
      .normalized();
}

// A torus with dents, of about 4 cm: bulges, hollows, saddles and sharp edges.
Decomposition DentedTorus(int around, int across, double dents) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  const auto index = [&](int i, int j) {
    return (i % around) * across + j % across;
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
      const double r = 0.012 * (1 + Uniform(-dents, dents));
      const double R = 0.03 + r * std::cos(v);
      vertices.emplace_back(R * std::cos(u), R * std::sin(u), r * std::sin(v));
      triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
      triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
    }
  }
  const std::vector<std::uint8_t> solid(triangles.size(), 1);
  return DecomposeSurface(vertices, triangles, solid);
}

bool IsListed(const DepthCandidate& facet,
              const std::vector<DepthCandidate>& facets) {
  return std::any_of(facets.begin(), facets.end(), [&](const auto& other) {
    return (facet.n - other.n).norm() < 1e-6 &&
           std::abs(facet.h - other.h) < 1e-9 &&
           facet.feature_A == other.feature_A &&
           facet.feature_B == other.feature_B;
  });
}

// All facets, and those of a cone down to a depth.
int CompareAt(const PosedPair& pair) {
  std::vector<DepthCandidate> all, listed, some;
  ListSupportedFacetsByBruteForce(pair, -1.0, &all);
  const WantedFacets anything{{Vec3::UnitX(), -1.0}, -1.0};
  ListSupportedFacets(pair, {0, 0}, {&anything, 1}, &listed);
  const WantedFacets wanted{{RandomDirection(), Uniform(-0.5, 0.9)},
                            -Uniform(0, 0.01)};
  ListSupportedFacets(pair, {0, 0}, {&wanted, 1}, &some);
  for (const DepthCandidate& facet : all) {
    CHECK(IsListed(facet, listed));
    const bool is_wanted = wanted.Hold(facet.n, facet.h);
    CHECK(is_wanted == IsListed(facet, some));
  }
  for (const DepthCandidate& facet : listed) CHECK(IsListed(facet, all));
  return static_cast<int>(all.size());
}

void TestAllPairsOfFeatures() {
  int found = 0;
  for (const double dents : {0.0, 0.1, 0.4}) {
    const Decomposition a = DentedTorus(12, 8, dents);
    const Decomposition b = DentedTorus(9, 7, dents / 2);
    for (int k = 0; k < 400; ++k) {
      const Polytope& A = a.pieces[generator() % a.pieces.size()];
      const Polytope& B = b.pieces[generator() % b.pieces.size()];
      Pose X_AB;
      X_AB.R = Eigen::AngleAxisd(Uniform(0, M_PI), RandomDirection())
                   .toRotationMatrix();
      X_AB.p = A.centroid - X_AB.R * B.centroid +
               Uniform(0, 0.01) * RandomDirection();
      found += CompareAt({A, B, X_AB});
    }
  }
  CHECK(found > 100);
}

// The cone of a piece holds the normals along which others meet it.
void TestConesAreNarrow() {
  const Decomposition body = DentedTorus(24, 16, 0.02);
  const auto narrow = std::count_if(
      body.pieces.begin(), body.pieces.end(),
      [](const Polytope& piece) { return piece.normal_cone.cosine > 0; });
  CHECK(narrow > 0.5 * static_cast<double>(body.pieces.size()));
}

// Nothing is left out however many features there are.
void TestLargePieces() {
  std::vector<Vec3> points;
  for (int k = 0; k < 300; ++k) points.push_back(RandomDirection());
  const Polytope ball = MakePolytope(points);
  Pose X_AB;
  X_AB.R = Eigen::AngleAxisd(0.3, RandomDirection()).toRotationMatrix();
  X_AB.p = 1.99 * RandomDirection();
  CHECK(CompareAt({ball, ball, X_AB}) > 300);
}

// A solid so thin that its piece is flat carries by its edges, outward.
void TestBlades() {
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i) {
    vertices.emplace_back(i & 1 ? 0.02 : -0.02, i & 2 ? 0.01 : -0.01,
                          i & 4 ? 1e-10 : 0);
  }
  const std::vector<Triangle> triangles{
      {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const std::vector<std::uint8_t> solid(triangles.size(), 1);
  const Decomposition blade = DecomposeSurface(vertices, triangles, solid);
  CHECK(blade.pieces.size() == 1 && blade.pieces[0].dimension == 2);
  int found = 0;
  for (int k = 0; k < 200; ++k) {
    Pose X_AB;
    X_AB.R = Eigen::AngleAxisd(Uniform(0, M_PI), RandomDirection())
                 .toRotationMatrix();
    X_AB.p = Uniform(0, 0.01) * RandomDirection();
    const PosedPair pair{blade.pieces[0], blade.pieces[0], X_AB};
    std::vector<DepthCandidate> all, listed;
    ListSupportedFacetsByBruteForce(pair, -1.0, &all);
    const WantedFacets anything{{Vec3::UnitX(), -1.0}, -1.0};
    ListSupportedFacets(pair, {0, 0}, {&anything, 1}, &listed);
    for (const DepthCandidate& facet : all) {
      // An edge nearly flush with a side is met by that side.
      const double flush =
          std::max(std::abs(facet.n.z()), std::abs(facet.n.dot(X_AB.R.col(2))));
      const bool is_edges = facet.feature_A.kind() == FeatureKind::kEdge;
      if (is_edges && flush > std::cos(2 * kSurfaceSlack)) continue;
      CHECK(IsListed(facet, listed));
      ++found;
    }
  }
  CHECK(found > 200);
}

// Two boxes whose edges are parallel but for round-off: such edges make no
// facet, and no point at which they pass each other.
void TestParallelEdges() {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(i & 1 ? 0.3 : -0.3, i & 2 ? 0.2 : -0.2,
                        i & 4 ? 0.1 : -0.1);
  }
  const Polytope box = MakePolytope(points);
  int found = 0;
  for (int k = 0; k < 300; ++k) {
    Pose X_AB;
    X_AB.R =
        Eigen::AngleAxisd(std::pow(10.0, Uniform(-17, -8)), RandomDirection())
            .toRotationMatrix();
    X_AB.p = Uniform(0, 0.2) * RandomDirection();
    const PosedPair pair{box, box, X_AB};
    const WantedFacets anything{{Vec3::UnitX(), -1.0}, -1.0};
    std::vector<DepthCandidate> listed;
    ListSupportedFacets(pair, {0, 0}, {&anything, 1}, &listed);
    for (const DepthCandidate& facet : listed) {
      const Witness witness = WitnessOfFeatures(
          pair, facet.feature_A, facet.feature_B, facet.n, facet.h);
      CHECK(witness.p_a.allFinite() && witness.p_b.allFinite());
      ++found;
    }
  }
  CHECK(found > 300);
}

// An axis and its opposite are in a cone of all directions, round-off or not.
void TestAllDirections() {
  const DirectionCone all;
  CHECK(all.Holds(Vec3(-1 - 2e-16, 0, 0)));
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TestAllPairsOfFeatures();
  drake_haptics::TestConesAreNarrow();
  drake_haptics::TestLargePieces();
  drake_haptics::TestBlades();
  drake_haptics::TestParallelEdges();
  drake_haptics::TestAllDirections();
  return drake_haptics::FailedChecks() > 0;
}
