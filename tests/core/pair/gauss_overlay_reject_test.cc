// Clipping a Gauss region against the overlay that it spares.
#include "pair/gauss_overlay_reject.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "check.h"
#include "pair/gauss_overlay.h"
#include "pair/random_ball.h"

namespace drake_haptics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The largest gap of all facets at a vertex pair: the overlay without a floor.
double LargestGap(const PosedPair& pair, const MinkowskiVertex& vertex_pair) {
  DepthWorkspace workspace;
  OverlayGaussRegions(pair, vertex_pair, SurfaceRule::kSurfaceOnly, -kInfinity,
                      &workspace);
  double largest = -kInfinity;
  for (const DepthCandidate& candidate : workspace.candidates) {
    largest = std::max(largest, candidate.h);
  }
  return largest;
}

void TestAgainstOverlay() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.5, 1.5);
  const auto vector = [&] {
    return Vec3(normal(random), normal(random), normal(random));
  };
  int spared = 0, kept = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Polytope A = MakeRandomBall(8 + trial % 60, &random);
    const Polytope B = MakeRandomBall(8 + trial % 37, &random);
    Pose X_AB;
    X_AB.R = Eigen::AngleAxisd(normal(random), vector().normalized())
                 .toRotationMatrix();
    X_AB.p = 0.4 * vector();
    const PosedPair pair{A, B, X_AB};
    MinkowskiVertex vertex_pair;
    SupportGap(pair, vector().normalized(), &vertex_pair);
    const double largest = LargestGap(pair, vertex_pair);
    if (!(largest < 0) || largest == -kInfinity) continue;
    const double floor = share(random) * largest;
    const Vec3 w = pair.a(vertex_pair.a) - pair.b(vertex_pair.b);
    const bool may_exceed = OverlayMayExceed(pair, vertex_pair, w, floor);
    if (largest > floor) CHECK(may_exceed);
    (may_exceed ? kept : spared) += largest > floor ? 0 : 1;
  }
  // It would be of no use if it kept what it could spare.
  CHECK(spared > 60);
  CHECK(spared > 20 * kept);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TestAgainstOverlay();
  return drake_haptics::FailedChecks() > 0;
}
