// The servo's tool against the constraint step that it repeats, and its slopes
// against what it answers a little farther.
#include "servo/servo_tool.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "check.h"
#include "servo/period_clock.h"
#include "servo/pressed_tool.h"

namespace drake_haptics {
namespace {

constexpr double kPeriod = 2.5e-4;
const Vec6 kStill = Vec6::Zero();

ServoTool Pressed(double depth, const PoseVector& q_WB) {
  ServoTool tool(MakeStepper(kPeriod), q_WB, {Above(kRest), kStill});
  for (int i = 0; i < 80; ++i) {
    // The handle in a base that is not turned: places differ by its own.
    PoseVector q_BH = Above(kRest - depth);
    q_BH.tail<3>() -= q_WB.tail<3>();
    tool.Step(q_BH, kStill, kStill);
  }
  return tool;
}

void StepsAsTheStepperDoes() {
  ConstraintStepper stepper = MakeStepper(kPeriod);
  const ToolState start{Above(kRest + 2e-3), kStill};
  ServoTool tool(stepper, PoseVector::Unit(0), start);
  ToolState state = start;
  ConstraintStepResult result;
  for (int i = 0; i < 150; ++i) {
    // Down to a millimeter below where the plate stops the tool, and up.
    const double height = kRest - 1e-3 + 3e-3 * std::cos(i / 20.0);
    Vec6 V = Vec6::Zero();
    V[5] = -3e-3 / 20.0 * std::sin(i / 20.0) / kPeriod;
    stepper.Step(state, Above(height), V, kStill, {}, &result);
    const LocalWrench wrench = tool.Step(Above(height), V, kStill);
    CHECK(wrench.F == result.F_Ho_W_commanded);
    CHECK(wrench.IsFinite());
    state = result.next;
    CHECK(tool.state().q_WT == state.q_WT);
    CHECK(tool.state().V_WT == state.V_WT);
    CHECK(state.q_WT[6] > kRest - 1e-6);
  }
}

// At a wall the handle feels the coupling along the normal and nothing across;
// and a new solution, once the tool rests, says what the slope said before.
void SlopesAreThoseOfTheNextSolution() {
  PoseVector q_WB = PoseVector::Unit(0);
  q_WB.tail<3>() << 0.01, -0.02, 0.03;
  ServoTool tool = Pressed(2e-3, q_WB);
  PoseVector q_BH = Above(kRest - 2e-3);
  q_BH.tail<3>() -= q_WB.tail<3>();
  const LocalWrench wrench = tool.Step(q_BH, kStill, kStill);
  CHECK(IsNear(wrench.F[5], kStiffness * 2e-3, 1e-3));
  CHECK(IsNear(wrench.K(5, 5), kStiffness, 1e-2));
  CHECK(IsNear(wrench.K(3, 3), 0, 1e-2));
  CHECK(IsNear(wrench.K(4, 4), 0, 1e-2));
  for (const double move : {-5e-4, 5e-4}) {
    PoseVector q_moved = q_BH;
    q_moved[6] += move;
    ServoTool next = tool;
    for (int i = 0; i < 60; ++i) next.Step(q_moved, kStill, kStill);
    const LocalWrench found = next.Step(q_moved, kStill, kStill);
    CHECK(IsNear(found.F[5], wrench.F[5] - wrench.K(5, 5) * move, 1e-3));
  }
}

// In free space the tool follows, and there is nothing to go on by.
void NothingHoldsItInFreeSpace() {
  ServoTool tool(MakeStepper(kPeriod), PoseVector::Unit(0),
                 {Above(0.05), kStill});
  for (int i = 0; i < 20; ++i) {
    const LocalWrench wrench = tool.Step(Above(0.051), kStill, kStill);
    CHECK(wrench.K.cwiseAbs().maxCoeff() < 1e-6);
    CHECK(wrench.B.cwiseAbs().maxCoeff() < 1e-6);
  }
}

void TheCouplingCanChange() {
  ServoTool tool = Pressed(2e-3, PoseVector::Unit(0));
  tool.SetGains({400, 1.0, 1.0, 4e-3, 0.5, 0.02});
  for (int i = 0; i < 60; ++i) tool.Step(Above(kRest - 2e-3), kStill, kStill);
  const LocalWrench wrench = tool.Step(Above(kRest - 2e-3), kStill, kStill);
  CHECK(IsNear(wrench.F[5], 0.5, 1e-3));  // it yields at its limit
}

void RefusesWhatIsNotAPose() {
  ServoTool tool = Pressed(1e-3, PoseVector::Unit(0));
  const ToolState before = tool.state();
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  PoseVector no_turn = Above(0.01);
  no_turn[0] = 0;
  CHECK_THROWS(tool.Step(Above(nan), kStill, kStill), std::invalid_argument);
  CHECK_THROWS(tool.Step(no_turn, kStill, kStill), std::invalid_argument);
  CHECK_THROWS(tool.Step(Above(0.01), Vec6::Constant(inf), kStill),
               std::invalid_argument);
  CHECK_THROWS(tool.Step(Above(0.01), kStill, Vec6::Constant(nan)),
               std::invalid_argument);
  CHECK_THROWS(tool.SetState({Above(nan), kStill}), std::invalid_argument);
  CHECK_THROWS(tool.SetState({Above(0), Vec6::Constant(nan)}),
               std::invalid_argument);
  CHECK(tool.state().q_WT == before.q_WT);
  CHECK(tool.state().V_WT == before.V_WT);
}

// Turns at 0, 1, 2, ... ms; one of 3.4 ms costs itself, and no burst follows.
void ALateTurnIsCountedAndNotMadeUpFor() {
  PeriodClock clock(1e-3);
  double now = 5;
  const auto work = [&](double duration) {
    now += duration;
    const double rest = clock.EndTurn(now);
    now += rest;
    return rest;
  };
  CHECK(work(0.7) == 0);  // before the first turn nothing is late
  CHECK(IsNear(work(2e-4), 8e-4, 1e-12));
  CHECK(IsNear(work(1e-4), 9e-4, 1e-12));
  CHECK(clock.num_late() == 0);
  CHECK(work(3.4e-3) == 0);
  CHECK(clock.num_late() == 1);
  CHECK(IsNear(work(2e-4), 8e-4, 1e-12));
  CHECK(clock.num_late() == 1);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::StepsAsTheStepperDoes();
  drake_haptics::SlopesAreThoseOfTheNextSolution();
  drake_haptics::NothingHoldsItInFreeSpace();
  drake_haptics::TheCouplingCanChange();
  drake_haptics::RefusesWhatIsNotAPose();
  drake_haptics::ALateTurnIsCountedAndNotMadeUpFor();
  return drake_haptics::FailedChecks() > 0;
}
