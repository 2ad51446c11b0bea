// What the revisit of a facet excludes against the overlay of all facets
// around.
#include "pair/warm_facet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "check.h"
#include "pair/gauss_overlay.h"
#include "pair/minkowski_facet_vertices.h"
#include "pair/random_ball.h"

namespace drake_haptics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The shallowest facet around a vertex pair: the overlay without a floor.
DepthCandidate Shallowest(const PosedPair& pair,
                          const MinkowskiVertex& vertex_pair) {
  DepthWorkspace workspace;
  OverlayGaussRegions(pair, vertex_pair, SurfaceRule::kWholeBoundary,
                      -kInfinity, &workspace);
  DepthCandidate best;
  best.h = -kInfinity;
  for (const DepthCandidate& candidate : workspace.candidates) {
    if (candidate.h > best.h) best = candidate;
  }
  return best;
}

bool IsExcluded(const Revisit& facet, const MinkowskiVertex& vertex_pair) {
  if (facet.status == RevisitStatus::kMinimum) return true;
  const auto end = facet.open.begin() + facet.num_open;
  return facet.has_list &&
         std::find(facet.open.begin(), end, vertex_pair) == end;
}

void NothingExcludedIsShallower() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto vector = [&] {
    return Vec3(normal(random), normal(random), normal(random));
  };
  int minima = 0, excluded = 0, open = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Polytope A = MakeRandomBall(20 + trial % 200, &random);
    const Polytope B = MakeRandomBall(20 + trial % 137, &random);
    const Vec3 way = vector().normalized();
    const Pose X_AB{Eigen::AngleAxisd(normal(random), vector().normalized())
                        .toRotationMatrix(),
                    -1.7 * way};
    const PosedPair pair{A, B, X_AB};
    MinkowskiVertex vertex_pair;
    SupportGap(pair, (way + 0.05 * vector()).normalized(), &vertex_pair);
    const DepthCandidate facet = Shallowest(pair, vertex_pair);
    if (!(facet.h > -kInfinity)) continue;
    const Revisit again =
        RevisitFacet(pair, SurfaceRule::kWholeBoundary, facet.feature_A,
                     facet.feature_B, facet.n);
    CHECK(again.status != RevisitStatus::kGone);
    std::vector<MinkowskiVertex> corners;
    ListMinkowskiFacetVertices(pair, facet.feature_A, facet.feature_B, facet.n,
                               &corners);
    minima += again.status == RevisitStatus::kMinimum;
    for (const MinkowskiVertex& corner : corners) {
      if (!IsExcluded(again, corner)) {
        ++open;
        continue;
      }
      ++excluded;
      CHECK(Shallowest(pair, corner).h <= facet.h + Tie(pair));
    }
  }
  // Both occur: a proof, and a list of a part of the vertex pairs.
  CHECK(minima > 100);
  CHECK(excluded > 3 * minima + 100);
  CHECK(open > 100);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::NothingExcludedIsShallower();
  return drake_haptics::FailedChecks() > 0;
}
