#pragma once

#include <nanobind/nanobind.h>

#include "constraint/constraint_step.h"
#include "device/udp_servo.h"

namespace drake_haptics {

/// A UdpServo at whose end other Python threads run. Its binding lets them run
/// while a name is looked up, too.
class PythonUdpServo : public UdpServo {
 public:
  using UdpServo::UdpServo;
  ~PythonUdpServo() {
    const nanobind::gil_scoped_release release;
    Close();
  }
};

/// A copy of the core's stepper in a Python `ConstraintStepper`.
/// @throws nanobind::cast_error for anything else.
ConstraintStepper CopyStepper(nanobind::handle stepper);

}  // namespace drake_haptics
