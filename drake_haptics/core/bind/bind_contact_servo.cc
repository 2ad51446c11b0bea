#include <nanobind/stl/tuple.h>

#include <tuple>
#include <utility>

#include "bind/bind.h"
#include "bind/bind_servo.h"
#include "servo/contact_servo.h"
#include "servo/servo_tool.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using PythonContactServo = PythonServo<ContactServo>;

void BindServoTool(nb::module_& m) {
  nb::class_<ServoTool>(
      m, "ServoTool",
      "Solves the tool for a servo: each period is one exact step of contact "
      "from the device's newest handle state. It yields the local wrench that "
      "a `ServoLaw` extrapolates until the next period. It has no clock. Poses "
      "are [qw qx qy qz x y z], m; velocities [ω; v], rad/s and m/s; wrenches "
      "[τ; f], N·m and N.")
      .def(
          "__init__",
          [](ServoTool* self, nb::handle stepper, const PoseVector& q_WB,
             const ToolStateVector& start) {
            new (self)
                ServoTool(CopyStepper(stepper), q_WB, ToToolState(start));
          },
          nb::arg("stepper"), nb::arg("q_WB"), nb::arg("start"),
          nb::sig("def __init__(self, stepper: ConstraintStepper, q_WB: "
                  "numpy.typing.ArrayLike, start: numpy.typing.ArrayLike) -> "
                  "None"),
          "Copies a stepper, whose objects rest where they are.\n\n"
          "Args:\n"
          "    stepper: A `ConstraintStepper` of the servo's period.\n"
          "    q_WB: (7,) pose of the device's base in the world.\n"
          "    start: (13,) first pose and velocity of the tool in the "
          "world.\n\n"
          "Raises:\n    ValueError: Not a pose, or not finite.")
      .def_prop_ro("period_s", &ServoTool::period, "Duration of a period, s.")
      .def_prop_rw(
          "state", [](const ServoTool& self) { return ToVector(self.state()); },
          [](ServoTool& self, const ToolStateVector& state) {
            self.SetState(ToToolState(state));
          },
          "(13,) pose and velocity of the tool in the world.")
      .def("set_gains", &ServoTool::SetGains, nb::arg("gains"),
           "Changes the coupling from the next period on.")
      .def(
          "step",
          [](ServoTool& self, const PoseVector& q_BH, const Vec6& V_BH,
             const Vec6& F_applied) {
            const LocalWrench wrench = self.Step(q_BH, V_BH, F_applied);
            return std::tuple(wrench.F, wrench.K, wrench.B);
          },
          nb::arg("q_BH"), nb::arg("V_BH"),
          nb::arg("F_applied_To_W") = Vec6(Vec6::Zero()),
          nb::sig("def step(self, q_BH: numpy.typing.ArrayLike, V_BH: "
                  "numpy.typing.ArrayLike, F_applied_To_W: "
                  "numpy.typing.ArrayLike = ...) -> tuple[numpy.ndarray, "
                  "numpy.ndarray, numpy.ndarray]"),
          "Advances the tool by a period.\n\n"
          "Args:\n"
          "    q_BH, V_BH: Pose (7,) and velocity (6,) of the handle in the "
          "device's base frame.\n"
          "    F_applied_To_W: (6,) sum of all other wrenches on the tool, its "
          "weight among them. Defaults to zero.\n\n"
          "Returns:\n"
          "    The wrench (6,) on the handle in the base frame at the period's "
          "beginning, and its slopes K and B (6, 6), those of coupling and "
          "contact in series: the wrench changes by -K δ - B ΔV as the handle "
          "moves on.\n\n"
          "Raises:\n"
          "    ValueError: A value is not finite, or not a pose; the tool "
          "stays where it was.");
}

void BindThread(nb::module_& m) {
  using Status = ContactServoStatus;
  nb::class_<Status>(m, "ContactServoStatus",
                     "Counters and state of a `ContactServo`, counted from the "
                     "start.")
      .def_ro("num_solved", &Status::num_solved,
              "Number of periods in which contact was solved.")
      .def_ro("num_late", &Status::num_late,
              "Number of periods that were overrun: the servo went on with the "
              "linear wrench of the last one.")
      .def_ro("num_refused", &Status::num_refused,
              "Number of handle states that were not poses.")
      .def_ro("is_running", &Status::is_running, "Whether the thread runs.");

  nb::class_<PythonContactServo>(
      m, "ContactServo",
      "A thread that solves contact for a `UdpServo`, in each period with the "
      "device's newest handle state, and publishes the local wrench to it, "
      "which nothing else may do then. It runs without Python; only `close` "
      "waits for it. Only one thread of the program may use it.")
      .def(nb::init<PythonUdpServo*, const ServoTool&>(), nb::arg("servo"),
           nb::arg("tool"), nb::keep_alive<1, 2>(),
           nb::sig("def __init__(self, servo: UdpServo, tool: ServoTool) -> "
                   "None"),
           "Starts the thread, which waits for the first `renew`.\n\n"
           "Args:\n"
           "    servo: Servo that answers the device.\n"
           "    tool: Tool, which is copied.")
      .def("renew", &PythonContactServo::Renew, nb::arg("gains"),
           nb::arg("F_applied_To_W"),
           "Says that the loop goes on, and sets the coupling and the sum (6,) "
           "of the other wrenches on the tool at To in W, its weight among "
           "them. If this is not called in time, the servo releases the force "
           "by its law.")
      .def("set_share", &PythonContactServo::SetShare, nb::arg("share"),
           "Sets the share of the wrench that is shown, 0 to 1, from the next "
           "`renew` on.")
      .def_prop_ro(
          "tool_state",
          [](PythonContactServo& self) { return ToVector(self.tool()); },
          "(13,) newest pose and velocity of the tool in the world.")
      .def("status", &PythonContactServo::status,
           "Returns a `ContactServoStatus`.")
      .def("close", &PythonContactServo::Close,
           nb::call_guard<nb::gil_scoped_release>(),
           "Ends the thread, within a period. May be called again.");
}

}  // namespace

void BindContactServo(nb::module_& m) {
  BindServoTool(m);
  BindThread(m);
}

}  // namespace drake_haptics
