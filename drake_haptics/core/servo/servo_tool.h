#pragma once

#include <vector>

#include "base/frame_change.h"
#include "base/types.h"
#include "constraint/constraint_step.h"
#include "device/servo_law.h"

namespace drake_haptics {

/// Solves the tool for a servo: each period is one exact step of contact
/// (ConstraintStepper) from the device's newest handle state. It yields the
/// local wrench that the servo's law extrapolates until the next period. The
/// caller has the clock and the device.
class ServoTool {
 public:
  /// @param stepper stepper with the servo's period and its objects posed; they
  ///     rest.
  /// @param q_WB pose of the device's base in the world.
  /// @param start the tool's first state.
  /// @throws std::invalid_argument unless the poses are valid and all values
  ///         finite.
  ServoTool(ConstraintStepper stepper, const PoseVector& q_WB,
            const ToolState& start);

  double period() const { return stepper_.settings().period; }
  const ToolState& state() const { return state_; }

  /// Sets the state of the tool and clears the anchors of friction.
  /// @throws std::invalid_argument for a pose that is not valid or a velocity
  ///         that is not finite.
  void SetState(const ToolState& state);

  /// Changes the coupling.
  void SetGains(const CouplingGains& gains) { stepper_.SetGains(gains); }

  /// Advances the tool by a period.
  /// @param q_BH, V_BH pose and velocity of the handle in the device's base
  ///     frame.
  /// @param F_applied sum of the other wrenches on the tool at To in W, such as
  ///     its weight.
  /// @returns the wrench on the handle in the base frame at the period's
  ///          beginning, with the slopes of coupling and contact in series
  ///          (ComputeHandleSlopes); the caller sets `published_at`.
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
