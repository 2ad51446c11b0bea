#pragma once

#include <vector>

#include "base/frame_change.h"
#include "base/types.h"
#include "constraint/constraint_step.h"
#include "device/servo_law.h"

namespace drake_haptics {

/// The tool as a servo solves it: each period is one exact step of contact
/// (ConstraintStepper) from the device's newest handle, and ends in the local
/// wrench that the servo's law carries on until the next. The clock and the
/// device are the caller's.
class ServoTool {
 public:
  /// @param stepper of the servo's period, its objects posed; they rest.
  /// @param q_WB pose of the device's base in the world.
  /// @param start the tool's first state.
  /// @throws std::invalid_argument unless the poses are poses and all is
  ///         finite.
  ServoTool(ConstraintStepper stepper, const PoseVector& q_WB,
            const ToolState& start);

  double period() const { return stepper_.settings().period; }
  const ToolState& state() const { return state_; }

  /// Puts the tool elsewhere, where friction holds it nowhere yet.
  /// @throws std::invalid_argument for a state that is no pose or not finite.
  void SetState(const ToolState& state);

  /// Changes the coupling.
  void SetGains(const CouplingGains& gains) { stepper_.SetGains(gains); }

  /// Advances the tool by a period.
  /// @param q_BH, V_BH the handle in the device's base frame.
  /// @param F_applied other wrenches on the tool at To in W: its weight.
  /// @returns the wrench on the handle in the base frame at the period's
  ///          beginning, with the slopes of coupling and contact in series
  ///          (ComputeHandleSlopes); `published_at` is left to the caller.
  /// @throws as ConstraintStepper::Step; the tool stays where it was.
  LocalWrench Step(const PoseVector& q_BH, const Vec6& V_BH,
                   const Vec6& F_applied);

 private:
  ConstraintStepper stepper_;
  FrameChange base_;
  ToolState state_;
  std::vector<double> anchors_;  // of friction
  ConstraintStepResult result_;
};

}  // namespace drake_haptics
