// What stands between data and a hand: limits, slopes and the loop, with
// anything put in.
#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "any_values.h"
#include "base/positive_semidefinite.h"
#include "base/wrench_limit.h"
#include "check.h"
#include "shapes.h"
#include "tool/handle_model.h"
#include "tool/tool_loop.h"

namespace drake_haptics {
namespace {

void NoWrenchLeavesTheLimits() {
  int num_limited = 0, num_not_finite = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec6 F = Any<Vec6>();
    const LimitedWrench limited = LimitWrench(F, kMaxTorque, kMaxForce);
    CHECK(IsWithin(limited.F));
    CHECK((limited.fate == WrenchFate::kNotFinite) == !F.allFinite());
    if (limited.fate == WrenchFate::kNotFinite) CHECK(limited.F.isZero(0));
    num_limited += limited.fate == WrenchFate::kLimited;
    num_not_finite += limited.fate == WrenchFate::kNotFinite;
  }
  CHECK(num_limited > 1000 && num_not_finite > 1000);
}

// By a Cholesky decomposition, which takes the compiler a fraction of what the
// eigenvalues take it.
bool HasNoEigenvalueBelow(double bound, const Mat6& symmetric) {
  const Mat6 lifted = symmetric - bound * Mat6::Identity();
  return lifted.llt().info() == Eigen::Success;
}

void NoSlopeGivesEnergy() {
  std::normal_distribution<double> normal;
  for (int k = 0; k < 300; ++k) {
    const Mat6 any = Mat6::NullaryExpr([&] { return normal(generator); });
    bool changed = false;
    const Mat6 passive = ProjectToPositiveSemidefinite(any, &changed);
    CHECK(changed);
    CHECK(passive.isApprox(passive.transpose(), 1e-12));
    CHECK(HasNoEigenvalueBelow(-1e-12 * passive.norm(), passive));
    changed = false;
    CHECK(ProjectToPositiveSemidefinite(passive, &changed)
              .isApprox(passive, 1e-9));
    CHECK(!changed);
  }
}

// As a servo needs them, whatever springs there are.
void SlopesAtTheHandleGiveNoEnergy() {
  std::normal_distribution<double> normal;
  const auto spring = [&normal] {
    const Mat6 root = Mat6::NullaryExpr([&] { return normal(generator); });
    return Mat6(root * root.transpose());
  };
  for (int k = 0; k < 300; ++k) {
    const WrenchModel coupling{Vec6::Zero(), spring(), spring()};
    const WrenchModel contact{Vec6::Zero(), spring(), spring()};
    const Vec3 p(normal(generator), normal(generator), normal(generator));
    const HandleSlopes slopes = ComputeHandleSlopes(p, coupling, contact);
    for (const Mat6& slope : {slopes.K, slopes.B}) {
      CHECK(slope.isApprox(slope.transpose(), 1e-9));
      CHECK(HasNoEigenvalueBelow(-1e-9 * slope.norm(), slope));
    }
  }
}

// A hand that holds the tool 2 mm deep in the floor, by a coupling half as
// stiff as the contact: they are in balance at the floor.
void ATickGoesToTheRestOfTwoSprings() {
  ToolLoop::Settings settings;
  settings.inertia.mass = 0.1;
  settings.inertia.p_TTcm.setZero();
  settings.inertia.I_TTcm_T = 1e-5 * Mat3::Identity();
  settings.gains = {500, 10, 0.5, 5e-3};
  settings.q_HT = PoseVector::Unit(0);
  settings.materials = {{1000, 5}};
  settings.period = 1e-3;
  const double tolerance = 1e-3;
  ContactTracker tracker(MakeBox(Vec3(0.01, 0.01, 0.01)),
                         {MakeBox(Vec3(0.1, 0.1, 0.02))}, tolerance);
  tracker.SetObjectPose(0, {Mat3::Identity(), Vec3(0, 0, -0.02)});
  ToolLoop loop(std::move(tracker), settings);
  PoseVector q_WH = PoseVector::Unit(0);
  q_WH[6] = 0.01 - 2e-3;
  ToolState state;
  state.q_WT = PoseVector::Unit(0);
  state.q_WT[6] = 0.02;
  state.V_WT.setZero();
  for (int k = 0; k < 1500; ++k) loop.Step(q_WH, Vec6::Zero(), &state);
  CHECK(loop.contacts().contacts.size() == 1);
  // 500 N/m (2 mm − z) = 1000 N/m (z + 1 mm), z the depth.
  CHECK(std::abs(state.q_WT[6] - 0.01) < 1e-6);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::NoWrenchLeavesTheLimits();
  drake_haptics::NoSlopeGivesEnergy();
  drake_haptics::SlopesAtTheHandleGiveNoEnergy();
  drake_haptics::ATickGoesToTheRestOfTwoSprings();
  return drake_haptics::FailedChecks() > 0;
}
