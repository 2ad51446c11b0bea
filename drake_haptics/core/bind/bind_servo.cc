#include "bind/bind_servo.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <optional>
#include <tuple>

#include "bind/bind.h"
#include "bind/bind_device.h"
#include "device/servo_law.h"
#include "tool/handle_model.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using OptionalSlope = std::optional<Mat6>;

LocalWrench ToLocalWrench(const Vec6& F, const PoseVector& X, const Vec6& V,
                          const OptionalSlope& K, const OptionalSlope& B,
                          double published_at) {
  const Mat6 none = Mat6::Zero();
  return {F, X, V, K.value_or(none), B.value_or(none), published_at};
}

void BindLaw(nb::module_& m) {
  nb::class_<ServoLaw>(
      m, "ServoLaw",
      "Computes the wrench that a servo shows between the ticks of a slower "
      "loop: the last local wrench F − K δ − B (V − V₀), δ = [rotation vector; "
      "translation] from X₀ to X, each of force and torque within its limit. A "
      "wrench that is not renewed is shown for `hold_s`, then goes to zero "
      "within `release_s`; a wrench that is renewed comes back within "
      "`engage_s`. Wrenches are [τ; f] at the handle's origin, N·m and N, in "
      "one frame with poses [qw qx qy qz x y z], m, and velocities [ω; v], "
      "rad/s and m/s.")
      .def(
          "__init__",
          [](ServoLaw* self, double max_force, double max_torque, double hold,
             double release, double engage) {
            new (self) ServoLaw(ServoTimes{hold, release, engage});
            self->SetLimits(max_force, max_torque);
          },
          nb::kw_only(), nb::arg("max_force_N"), nb::arg("max_torque_Nm"),
          nb::arg("hold_s") = ServoTimes().hold,
          nb::arg("release_s") = ServoTimes().release,
          nb::arg("engage_s") = ServoTimes().engage,
          "Raises:\n    ValueError: a time is not finite and above zero.")
      .def(
          "adopt",
          [](ServoLaw& self, const Vec6& F, const PoseVector& X, const Vec6& V,
             const OptionalSlope& K, const OptionalSlope& B,
             double time) { self.Adopt(ToLocalWrench(F, X, V, K, B, time)); },
          nb::arg("F"), nb::arg("X"), nb::arg("V"), nb::arg("K").none(),
          nb::arg("B").none(), nb::arg("time_s"),
          "Takes a wrench (6,) as of `time_s`, for the pose X₀ (7,) and the "
          "velocity V₀ (6,), with its slopes K and B (6, 6). Only the nearest "
          "symmetric slope without a negative eigenvalue acts, so that the "
          "servo is passive. A value that is not finite ends all "
          "force at once.")
      .def(
          "step", &ServoLaw::Step, nb::arg("time_s"), nb::arg("X"),
          nb::arg("V"),
          "Returns the wrench (6,) to show at `time_s`; zero where X (7,) or V "
          "(6,) is not finite.")
      .def_prop_ro("scale", &ServoLaw::scale,
                   "Share of the wrench that is shown, 0 to 1.")
      .def_prop_ro("num_not_finite", &ServoLaw::num_not_finite,
                   "Number of wrenches and states that were not finite.")
      .def_prop_ro("num_not_passive", &ServoLaw::num_not_passive,
                   "Number of wrenches whose K or B was not passive.");
}

void BindState(nb::module_& m) {
  nb::class_<HandleState>(m, "HandleState",
                          "Last state that a device sent, in its base frame B.")
      .def_ro("number", &HandleState::number,
              "Rises with every state that counts, also when the driver is "
              "restarted.")
      .def_ro("time_s", &HandleState::time, "Time by the driver's clock, s.")
      .def_prop_ro("X_BH", &ArrayOf<&HandleState::X, HandleState>,
                   "(7,) pose [qw qx qy qz x y z], m.")
      .def_prop_ro("V_BH", &ArrayOf<&HandleState::V, HandleState>,
                   "(6,) velocity [ω; v], rad/s and m/s.")
      .def_prop_ro("F_Ho_B", &ArrayOf<&HandleState::F, HandleState>,
                   "(6,) wrench that the device showed, [τ; f], N·m and N.")
      .def_ro("max_force_N", &HandleState::max_force, "The device's limit, N.")
      .def_ro("max_torque_Nm", &HandleState::max_torque,
              "The device's limit, N·m.")
      .def_ro("buttons", &HandleState::buttons, "Bit i: button i is held.")
      .def_ro("gate", &HandleState::gate, "State, a number of `GateState`.")
      .def_ro("fault", &HandleState::fault, "Fault, a number of `Fault`.");
}

void BindStatus(nb::module_& m) {
  using Status = UdpServoStatus;
  nb::class_<Status> status(
      m, "UdpServoStatus",
      "Counters and state of a `UdpServo`, counted from the start.");
  const auto count = [&status](const char* name, auto member, const char* doc) {
    status.def_prop_ro(
        name, [member](const Status& self) { return self.counts.*member; },
        doc);
  };
  count("received", &LinkCounts::received,
        "Valid states that came, late and duplicate ones too.");
  count("lost", &LinkCounts::lost, "States that never came, by the gaps.");
  count("late", &LinkCounts::late, "States that came after a newer one.");
  count("duplicate", &LinkCounts::duplicate, "States that had come before.");
  count("damaged", &LinkCounts::damaged, "Packets that are not a whole state.");
  count("not_finite", &LinkCounts::not_finite,
        "States without a finite pose, velocity and wrench.");
  count("restarts", &LinkCounts::restarts, "Restarts of the driver.");
  count("silences", &LinkCounts::silences,
        "Silences of the driver that were so long that the servo looked for it "
        "again.");
  count("refused", &LinkCounts::refused,
        "Packets that the driver refused, by its own count.");
  status.def_ro("sent", &Status::sent, "Commands sent.")
      .def_ro("wrenches_not_finite", &Status::num_not_finite,
              "Wrenches and states that were not finite: force ended.")
      .def_ro("wrenches_not_passive", &Status::num_not_passive,
              "Wrenches whose K or B was not passive, and was projected.")
      .def_ro("scale", &Status::scale, "Share of the wrench that is sent.")
      .def_ro("is_running", &Status::is_running, "Whether the thread runs.")
      .def_ro("is_heard", &Status::is_heard, "Whether states are coming.")
      .def_ro("is_active", &Status::is_active, "Whether a wrench may be shown.")
      .def_ro("has_realtime_priority", &Status::has_priority,
              "Whether the system granted the thread real-time priority.")
      .def_ro("has_locked_memory", &Status::has_locked_memory,
              "Whether the system keeps the servo from being paged out.");
}

void BindUdpServo(nb::module_& m) {
  const UdpServoOptions defaults;
  nb::class_<PythonUdpServo>(
      m, "UdpServo",
      "A thread that answers every state of a device's driver with the wrench "
      "of a `ServoLaw`. It runs without Python; only `close` waits for it. "
      "Only one thread of the program may use it.")
      .def(
          "__init__",
          [](PythonUdpServo* self, const std::string& host, std::uint16_t port,
             double ttl, double max_rate, double max_force, double max_torque,
             double hold, double release, double engage) {
            new (self) PythonUdpServo(host, port,
                                      {ttl,
                                       max_rate,
                                       max_force,
                                       max_torque,
                                       {hold, release, engage}});
          },
          nb::call_guard<nb::gil_scoped_release>(), nb::arg("host"),
          nb::arg("port"), nb::kw_only(),
          nb::arg("ttl_s") = defaults.time_to_live,
          nb::arg("max_rate_hz") = defaults.max_rate,
          nb::arg("max_force_N") = defaults.max_force,
          nb::arg("max_torque_Nm") = defaults.max_torque,
          nb::arg("hold_s") = defaults.times.hold,
          nb::arg("release_s") = defaults.times.release,
          nb::arg("engage_s") = defaults.times.engage,
          "Starts the thread, which looks for the driver at that address.\n\n"
          "Args:\n"
          "    host: name or address, IPv4 or IPv6.\n"
          "    port: UDP port.\n"
          "    ttl_s: time that the device shows a command that is not "
          "renewed. A silence of the driver for twice that time, and at least "
          "half a second, is a fault.\n"
          "    max_rate_hz: largest rate of commands.\n"
          "    max_force_N, max_torque_Nm: largest norms, where the device "
          "allows more.\n"
          "    hold_s, release_s, engage_s: times of the `ServoLaw`.\n\n"
          "Raises:\n"
          "    ValueError: a time or the rate is not finite and above zero, or "
          "a limit is negative or NaN.\n"
          "    RuntimeError: there is no such host, or no socket is available.")
      .def(
          "read",
          [](PythonUdpServo& self) -> std::optional<HandleState> {
            const HandleState state = self.Read();
            if (state.number == 0) return std::nullopt;
            return state;
          },
          "Returns the newest `HandleState`; None before the first.")
      .def(
          "publish",
          [](PythonUdpServo& self, const Vec6& F, const PoseVector& X,
             const Vec6& V, const OptionalSlope& K, const OptionalSlope& B) {
            self.Publish(ToLocalWrench(F, X, V, K, B, 0));
          },
          nb::arg("F_Ho_B"), nb::arg("X_BH"), nb::arg("V_BH"),
          nb::arg("K_B").none() = nb::none(),
          nb::arg("B_B").none() = nb::none(),
          "Shows a local wrench from now on, as `ServoLaw.adopt` does; the "
          "first one enables the device.")
      .def("recover", &PythonUdpServo::Recover,
           "Recovers from a fault: disabled until the device is idle, then "
           "enabled.")
      .def("close", &PythonUdpServo::Close,
           nb::call_guard<nb::gil_scoped_release>(),
           "Disables the device and ends the thread, in some 30 ms. May be "
           "called again.")
      .def("status", &PythonUdpServo::status, "Returns a `UdpServoStatus`.")
      .def(
          "lateness_s",
          [](const PythonUdpServo& self) {
            const LatenessHistogram& lateness = self.lateness();
            return std::tuple(lateness.Quantile(0.5), lateness.Quantile(0.99),
                              lateness.Quantile(0.999));
          },
          "Returns p50, p99 and p99.9 of the lateness of answers, s, relative "
          "to the promptest one of the last 10 to 20 s, rounded up by at most "
          "a fifth.")
      .def_prop_ro("local_port", &PythonUdpServo::local_port,
                   "Our own UDP port.");
}

}  // namespace

void BindServo(nb::module_& m) {
  BindLaw(m);
  BindState(m);
  BindStatus(m);
  BindUdpServo(m);
  m.def(
      "handle_slopes",
      [](const PoseVector& q_WH, const PoseVector& q_WT,
         const WrenchModelVector& coupling, const WrenchModelVector& contact) {
        return ToVector(ComputeHandleSlopes(q_WT.tail<3>() - q_WH.tail<3>(),
                                            ToWrenchModel(coupling),
                                            ToWrenchModel(contact)));
      },
      nb::arg("q_WH"), nb::arg("q_WT"), nb::arg("coupling_model"),
      nb::arg("contact_model"),
      "Slopes of the wrench on a handle by the handle's motion, with the tool "
      "in equilibrium between coupling and contact (springs in series; Guyan, "
      "AIAA Journal 3(2), 1965).\n\n"
      "Args:\n"
      "    q_WH, q_WT: (7,) poses [qw qx qy qz x y z] of handle and tool.\n"
      "    coupling_model: (78,) [F; K; B] of the coupling on the tool, at To "
      "in W.\n"
      "    contact_model: (78,) sum of all other wrench models.\n\n"
      "Returns:\n"
      "    (72,): K then B by rows, at Ho in W; symmetric, without a negative "
      "eigenvalue. The wrench is F − K δ − B ΔV.");
}

}  // namespace drake_haptics
