#include "servo/servo_tool.h"

#include <stdexcept>
#include <utility>

#include "tool/handle_model.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

ServoTool::ServoTool(ConstraintStepper stepper, const PoseVector& q_WB,
                     const ToolState& start)
    : stepper_(std::move(stepper)), base_(q_WB) {
  SetState(start);
}

void ServoTool::SetState(const ToolState& state) {
  PoseFromVector(state.q_WT, "X_WT");
  if (!state.V_WT.allFinite()) {
    throw std::invalid_argument("V_WT must be finite");
  }
  state_ = state;
  anchors_.assign(stepper_.num_anchors(), 0.0);
}

LocalWrench ServoTool::Step(const PoseVector& q_BH, const Vec6& V_BH,
                            const Vec6& F_applied) {
  const Eigen::Matrix<double, 13, 1> handle = base_.ChangeMotion(q_BH, V_BH);
  const PoseVector q_WH = handle.head<7>();
  const Vec6 V_WH = handle.tail<6>();
  stepper_.Step(state_, q_WH, V_WH, F_applied, anchors_, &result_);
  const ConstraintStepper::Settings& settings = stepper_.settings();
  const WrenchModel coupling =
      ComputeCoupling(q_WH, V_WH, settings.q_HT, state_.q_WT, state_.V_WT,
                      settings.gains)
          .tool;
  WrenchModel contact = result_.friction.tool;
  contact.K += result_.contact_stiffness;
  const HandleSlopes slopes = ComputeHandleSlopes(
      state_.q_WT.tail<3>() - q_WH.tail<3>(), coupling, contact);
  state_ = result_.next;
  anchors_ = result_.friction.next_state;
  return {base_.ChangeBack(result_.F_Ho_W_commanded), q_BH, V_BH,
          base_.ChangeBack(slopes.K), base_.ChangeBack(slopes.B)};
}

}  // namespace drake_haptics
