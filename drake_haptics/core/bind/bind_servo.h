#pragma once

#include <nanobind/nanobind.h>

#include "constraint/constraint_step.h"
#include "device/udp_servo.h"

namespace drake_haptics {

/// A servo at whose end other Python threads run.
template <typename Servo>
class PythonServo : public Servo {
 public:
  using Servo::Servo;
  ~PythonServo() {
    const nanobind::gil_scoped_release release;
    this->Close();
  }
};
using PythonUdpServo = PythonServo<UdpServo>;

/// A copy of the core's stepper in a Python `ConstraintStepper`.
/// @throws nanobind::cast_error for anything else.
ConstraintStepper CopyStepper(nanobind::handle stepper);

}  // namespace drake_haptics
