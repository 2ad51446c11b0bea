// The query of a convex pair on its way through another body: against queries
// that know nothing of the way, and that a warm one allocates nothing.
#include "pair/convex_pair.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "allocations.h"
#include "check.h"
#include "pair/random_ball.h"

namespace drake_haptics {
namespace {

// A ball drawn out to an ellipsoid, of which the inner ball is a small part.
Polytope MakeBody(int n, const Vec3& radii, std::mt19937* random) {
  std::vector<Vec3> points = MakeRandomBall(n, random).vertices;
  for (Vec3& p : points) p = p.cwiseProduct(radii);
  return MakePolytope(points);
}

// In, past the centers, and out, turning.
std::vector<Pose> MakeWay(const Vec3& along, const Vec3& beside) {
  std::vector<Pose> way;
  for (int tick = 0; tick < 500; ++tick) {
    const double t = 2e-3 * tick;
    way.push_back({Eigen::AngleAxisd(t, beside).toRotationMatrix(),
                   2.2 * std::cos(6.28 * t) * along + 0.3 * beside});
  }
  return way;
}

class Tracked {
 public:
  Tracked(const Polytope& A, const Polytope& B, bool is_global)
      : A_(A), B_(B), is_global_(is_global) {}

  PairContact Query(const Pose& X_AB) {
    return QueryConvexPair({A_, B_, X_AB}, &state_, &workspace_,
                           is_global_ ? &global_ : nullptr);
  }

 private:
  const Polytope &A_, &B_;
  const bool is_global_;
  PairState state_;
  PairWorkspace workspace_;
  GlobalDepthState global_;
};

void KeepsToTheTruth() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int deep = 0, apart = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Vec3 radii(1, trial % 2 == 0 ? 0.9 : 0.2, trial % 3 == 0 ? 0.8 : 0.1);
    const Polytope A = MakeBody(10 + 30 * trial, radii, &random);
    const Polytope B = MakeBody(10 + 20 * trial, radii, &random);
    const Vec3 along =
        Vec3(normal(random), normal(random), normal(random)).normalized();
    Tracked local(A, B, false), global(A, B, true);
    for (const Pose& X_AB : MakeWay(along, along.unitOrthogonal())) {
      const double truth = Tracked(A, B, true).Query(X_AB).distance;
      const double found = local.Query(X_AB).distance;
      CHECK(std::abs(global.Query(X_AB).distance - truth) < 1e-9);
      // Apart there is one distance; in depth a local one is as deep or deeper.
      CHECK(truth > 0 ? std::abs(found - truth) < 1e-9 : found < truth + 1e-9);
      ++(truth > 0 ? apart : deep);
    }
  }
  CHECK(deep > 1000 && apart > 1000);
}

void AllocatesNothingOnTheSecondPass() {
  std::mt19937 random(4);
  const Polytope A = MakeBody(300, {1, 0.9, 0.8}, &random);
  const Polytope B = MakeBody(200, {1, 0.7, 0.2}, &random);
  const std::vector<Pose> way = MakeWay(Vec3::UnitX(), Vec3::UnitY());
  for (const bool is_global : {false, true}) {
    Tracked pair(A, B, is_global);
    for (const Pose& X_AB : way) (void)pair.Query(X_AB);
    for (const Pose& X_AB : way) (void)pair.Query(X_AB);
    const long before = allocations;
    int deep = 0;
    for (const Pose& X_AB : way) deep += pair.Query(X_AB).distance < 0;
    CHECK(allocations == before);
    CHECK(deep > 100);
  }
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::KeepsToTheTruth();
  drake_haptics::AllocatesNothingOnTheSecondPass();
  return drake_haptics::FailedChecks() > 0;
}
