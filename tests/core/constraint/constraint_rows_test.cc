// Rows against all pairs of pieces, asked one by one from nothing; what they
// prove; and that a warm tick allocates nothing.
#include "constraint/constraint_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "allocations.h"
#include "check.h"
#include "constraint/constraint_step.h"
#include "pair/separation.h"
#include "shapes.h"

using namespace drake_haptics;

namespace {

using Name = std::tuple<int, int, int>;  // object, pieces
constexpr double kSkin = 3e-4;

// The tool's way at tick k: past the objects, turning.
Pose Way(int k) {
  const double t = 1e-3 * k;
  const Vec3 turn(std::sin(5 * t), std::cos(3 * t), 0.5 * std::sin(2 * t));
  return {Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix(),
          Vec3(0.05 * std::sin(4 * t), 0.02 * std::cos(6 * t),
               0.07 + 0.02 * std::cos(5 * t))};
}

std::map<Name, double> AskAllPairs(const Decomposition& tool,
                                   const std::vector<Shape>& objects,
                                   const std::vector<Pose>& X_WO,
                                   const Pose& X_WT, double reach) {
  std::map<Name, double> distances;
  for (int i = 0; i < static_cast<int>(objects.size()); ++i) {
    const Pose X_AB = RelativePose(X_WT, X_WO[i]);
    for (int a = 0; a < static_cast<int>(tool.pieces.size()); ++a) {
      for (int b = 0; b < static_cast<int>(objects[i]->pieces.size()); ++b) {
        const Separation found = ComputeSeparation(
            {tool.pieces[a], objects[i]->pieces[b], X_AB}, {}, 1.0);
        if (found.distance > 0 && found.distance <= reach) {
          distances[{i, a, b}] = found.distance;
        }
      }
    }
  }
  return distances;
}

// With objects that rest and move, and reaches that change.
void TheyAreAllPairsWithinReach() {
  const Shape tool = MakeSwarm(6);
  const std::vector<Shape> objects{MakeSwarm(12), MakeSwarm(5)};
  ConstraintRows rows(tool, objects, {kSkin, kSkin});
  std::vector<Pose> X_WO(2);
  int num_found = 0;
  for (int k = 0; k < 1500; k += 3) {
    X_WO[1].p.x() = 0.01 * std::sin(0.01 * k);
    rows.SetObjectPose(1, X_WO[1], 0);
    const double reach = k % 2 == 0 ? 2e-2 : 5e-3;
    rows.Query(Way(k), reach);
    if (!(rows.least_distance() > 0)) continue;
    auto expected =
        AskAllPairs(*tool, objects, X_WO, Way(k), kSkin + reach + 1e-12);
    double free = 1;
    for (const auto& [name, distance] :
         AskAllPairs(*tool, objects, X_WO, Way(k), 1)) {
      if (expected.count(name) == 0) free = std::min(free, distance - kSkin);
    }
    CHECK(rows.FreeMotion() <= std::max(free, reach) + 1e-12);
    for (const SeparatingPlane& plane : rows.planes()) {
      const auto found =
          expected.find({plane.object, plane.pieces.a, plane.pieces.b});
      CHECK(found != expected.end());
      if (found == expected.end()) continue;
      CHECK(std::abs(found->second - plane.contact.distance) < 1e-12);
      expected.erase(found);
      ++num_found;
    }
    CHECK(expected.empty());
  }
  CHECK(num_found > 100);
}

// (P1): along its normal a row tells how near a translation brings the pieces,
// whatever its size, and however its plane was turned.
void ARowBoundsTheDistanceAfterATranslation() {
  int num_turned = 0;
  for (int k = 0; k < 300; ++k) {
    const Shape tool = MakeSwarm(1), object = MakeSwarm(1);
    const Pose X_WT{Mat3::Identity(), RandomPoint(0.01)};
    const double distance =
        ComputeSeparation(
            {tool->pieces[0], object->pieces[0], RelativePose(X_WT, Pose())},
            {}, 1.0)
            .distance;
    if (!(distance > 0)) continue;
    ConstraintRows rows(tool, {object}, {kSkin});
    rows.Query(X_WT, 0.1);
    CHECK(rows.planes().size() == 1);
    if (k % 2 == 1) {
      const Pose X_next{Mat3::Identity(), X_WT.p + RandomPoint(0.02)};
      const double least = 0.5 * distance;
      const bool is_turned = rows.TurnPlane(0, X_next, Pose(), least);
      num_turned += is_turned;
      CHECK(rows.planes()[0].contact.distance >= least);
      rows.UpdateRows();
    }
    for (int j = 0; j < 20; ++j) {
      const Vec3 t = RandomPoint(0.02);
      const double then =
          ComputeSeparation({tool->pieces[0], object->pieces[0],
                             RelativePose({X_WT.R, X_WT.p + t}, Pose())},
                            {}, 1.0)
              .distance;
      double told = 1;
      for (const ConstraintRow& row : rows.rows()) {
        told = std::min(told, row.distance + row.a.tail<3>().dot(t));
      }
      CHECK(then >= told - 1e-12);
    }
  }
  CHECK(num_turned > 30);
}

// A box above another one, their overlap known in closed form.
void FlushFacesHaveARowAtEachCornerOfTheirOverlap() {
  ConstraintRows rows(MakeBox({0.01, 0.02, 0.005}),
                      {MakeBox({0.03, 0.03, 0.01})}, {kSkin});
  rows.Query({Mat3::Identity(), Vec3(0.025, -0.015, 0.0153)}, 1e-4);
  CHECK(rows.planes().size() == 1);
  for (const double x : {0.015, 0.03}) {
    for (const double y : {-0.03, 0.005}) {
      const auto is_corner = [&](const ConstraintRow& row) {
        return (row.p_WCb - Vec3(x, y, 0.01)).norm() < 1e-12 &&
               (row.p_WCa - Vec3(x, y, 0.0103)).norm() < 1e-12 &&
               (row.n - Vec3::UnitZ()).norm() < 1e-12;
      };
      CHECK(std::any_of(rows.rows().begin(), rows.rows().end(), is_corner));
    }
  }
}

ConstraintStepper MakeStepper(double period) {
  ConstraintStepper::Settings settings;
  settings.inertia = {0.05, Vec3::Zero(), 1e-5 * Mat3::Identity()};
  settings.gains = {800, 2, 1, 0.004};
  settings.q_HT << 1, 0, 0, 0, 0, 0, 0;
  settings.period = period;
  settings.skin = {kSkin, kSkin};
  return ConstraintStepper(
      MakeSwarm(3), {MakeBox({0.06, 0.06, 0.03}), MakeSwarm(5)}, settings);
}

void AWarmTickAllocatesNothing() {
  ConstraintStepper stepper = MakeStepper(1e-3);
  ConstraintStepResult result;
  const auto run = [&] {
    ToolState state;
    state.q_WT << 1, 0, 0, 0, 0, 0, 0.12;
    state.V_WT.setZero();
    int num_contacts = 0;
    for (int k = 0; k < 1200; ++k) {
      PoseVector q_WH = state.q_WT;
      q_WH.head<4>() << 1, 0, 0, 0;
      q_WH.tail<3>() << 0.02 * std::sin(0.01 * k), 0, 0.12 - 1e-4 * k;
      stepper.Step(state, q_WH, Vec6::Zero(), Vec6::Zero(), {}, &result);
      state = result.next;
      num_contacts += static_cast<int>(result.contacts.contacts.size());
    }
    return num_contacts;
  };
  CHECK(run() > 100);
  stepper.Reset();
  const long before = allocations;
  run();
  CHECK(allocations == before);
}

// Copies go on alike and apart from one another, to the bit.
void ACopyGoesOnAsTheFirst() {
  ConstraintStepper stepper = MakeStepper(1e-3);
  ConstraintStepResult result, copied;
  ToolState state;
  state.q_WT << 1, 0, 0, 0, 0, 0, 0.1;
  state.V_WT.setZero();
  for (int k = 0; k < 600; ++k) {
    PoseVector q_WH;
    q_WH << 1, 0, 0, 0, 0, 0, 0.1 - 1e-4 * k;
    ConstraintStepper copy = stepper;
    copy.Step(state, q_WH, Vec6::Zero(), Vec6::Zero(), {}, &copied);
    stepper.Step(state, q_WH, Vec6::Zero(), Vec6::Zero(), {}, &result);
    CHECK(copied.next.q_WT == result.next.q_WT);
    CHECK(copied.next.V_WT == result.next.V_WT);
    state = result.next;
  }
}

}  // namespace

int main() {
  TheyAreAllPairsWithinReach();
  ARowBoundsTheDistanceAfterATranslation();
  FlushFacesHaveARowAtEachCornerOfTheirOverlap();
  AWarmTickAllocatesNothing();
  ACopyGoesOnAsTheFirst();
  return FailedChecks() > 0;
}
