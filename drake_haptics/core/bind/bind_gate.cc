#include <drake_haptics/gate.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include <cstdint>
#include <map>
#include <sstream>

#include "base/types.h"
#include "bind/bind.h"
#include "bind/bind_device.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

dh_gate MakeGate(const dh_gate_limits& limits) {
  dh_gate gate;
  if (const char* problem = dh_gate_init(&gate, &limits)) {
    std::ostringstream text;
    text << problem << "; got max_force_N=" << limits.max_force_N
         << ", max_torque_Nm=" << limits.max_torque_Nm
         << ", max_speed_m_per_s=" << limits.max_speed_m_per_s
         << ", max_turn_rate_rad_per_s=" << limits.max_turn_rate_rad_per_s
         << ", ramp_in_s=" << limits.ramp_in_s
         << ", ramp_out_s=" << limits.ramp_out_s
         << ", max_ttl_s=" << limits.max_ttl_s;
    throw std::invalid_argument(text.str());
  }
  return gate;
}

std::uint64_t ReadTime(nb::int_ now_ns) {
  std::uint64_t time = 0;
  ReadCount("now_ns", now_ns, &time);
  return time;
}

Vec6 StepGate(dh_gate* gate, nb::int_ now_ns, nb::handle X_BH,
              nb::handle V_BH) {
  double X[7], V[6];
  Vec6 F;
  ReadReals(X_BH, "X_BH", X);
  ReadReals(V_BH, "V_BH", V);
  dh_gate_step(gate, ReadTime(now_ns), X, V, F.data());
  return F;
}

std::map<std::string, std::uint64_t> Counts(const dh_gate& gate) {
  std::map<std::string, std::uint64_t> counts;
  for (int i = 0; i < DH_VERDICT_COUNT; ++i) {
    counts[NameOf(static_cast<dh_verdict>(i))] = gate.counts[i];
  }
  return counts;
}

}  // namespace

void BindGate(nb::module_& m) {
  const dh_gate_limits usual = dh_gate_default_limits(0, 0);
  nb::class_<dh_gate>(
      m, "DeviceGate",
      "Safety gate between commands and a hand, in the driver's process: the "
      "state machine of gate.h (docs/device-protocol.md), with time as an "
      "argument. Force and torque never exceed the limits, in any state.")
      .def(
          "__init__",
          [](dh_gate* self, double max_force_N, double max_torque_Nm,
             double max_speed_m_per_s, double max_turn_rate_rad_per_s,
             double ramp_in_s, double ramp_out_s, double max_ttl_s) {
            new (self) dh_gate(MakeGate(
                {max_force_N, max_torque_Nm, max_speed_m_per_s,
                 max_turn_rate_rad_per_s, ramp_in_s, ramp_out_s, max_ttl_s}));
          },
          nb::kw_only(), nb::arg("max_force_N"), nb::arg("max_torque_Nm"),
          nb::arg("max_speed_m_per_s") = usual.max_speed_m_per_s,
          nb::arg("max_turn_rate_rad_per_s") = usual.max_turn_rate_rad_per_s,
          nb::arg("ramp_in_s") = usual.ramp_in_s,
          nb::arg("ramp_out_s") = usual.ramp_out_s,
          nb::arg("max_ttl_s") = usual.max_ttl_s,
          "Args:\n"
          "    max_force_N: Largest norm of the force, N; 0 for none.\n"
          "    max_torque_Nm: Largest norm of the torque, N·m; 0 for none.\n"
          "    max_speed_m_per_s: Largest speed of the handle, m/s; a faster "
          "one is a fault while active.\n"
          "    max_turn_rate_rad_per_s: Largest turn rate, rad/s, likewise.\n"
          "    ramp_in_s: Time from no force to full force, 0.001 to 10 s.\n"
          "    ramp_out_s: Time from full force to none, 0.001 to 1 s.\n"
          "    max_ttl_s: Longest time to live of a command, 1e-6 to 1 s.\n\n"
          "Raises:\n"
          "    ValueError: a limit is not finite or out of its bounds.")
      .def(
          "receive",
          [](dh_gate& gate, nb::int_ now_ns, const nb::bytes& data) {
            return NameOf(dh_gate_receive(&gate, ReadTime(now_ns), Data(data),
                                          data.size()));
          },
          nb::arg("now_ns"), nb::arg("data"),
          "Takes a packet with any content.\n\n"
          "Args:\n"
          "    now_ns: Time of the driver's monotonic clock, ns.\n"
          "    data: The datagram.\n\n"
          "Returns:\n"
          "    'accepted', or the reason for refusal: a key of `counts`.\n\n"
          "Raises:\n"
          "    ValueError: now_ns is not a 64-bit time.")
      .def("step", &StepGate, nb::arg("now_ns"), nb::arg("X_BH"),
           nb::arg("V_BH"),
           "Advances the time; called once per tick, after the packets.\n\n"
           "Args:\n"
           "    now_ns: Time of the driver's monotonic clock, ns.\n"
           "    X_BH: (7,) pose of the handle [qw qx qy qz x y z], m. A value "
           "that is not finite is a fault.\n"
           "    V_BH: (6,) spatial velocity of the handle [ω; v], rad/s and "
           "m/s; likewise.\n\n"
           "Returns:\n"
           "    (6,) the wrench to show [τ; f] at Ho in B, N·m and N.\n\n"
           "Raises:\n"
           "    ValueError: X_BH or V_BH has a wrong shape, or now_ns is not a "
           "64-bit time.")
      .def(
          "fail", [](dh_gate& gate) { dh_gate_fail(&gate); },
          "Reports a fault of the driver's own hardware: zero wrench at once.")
      .def_prop_ro(
          "state", [](const dh_gate& gate) { return int{gate.state}; },
          "State, a number of `backend.GateState`.")
      .def_prop_ro(
          "fault", [](const dh_gate& gate) { return int{gate.fault}; },
          "Fault, a number of `backend.Fault`.")
      .def_ro("session", &dh_gate::session,
              "Session of the host that is served, or 0.")
      .def_ro("command_sequence", &dh_gate::command_sequence,
              "Sequence of the newest command that was accepted.")
      .def_prop_ro(
          "command_F_Ho_B", &ArrayOf<&dh_gate::command_F_Ho_B, dh_gate>,
          "(6,) the newest wrench to show, within the limits, N·m and N.")
      .def_prop_ro("F_Ho_B", &ArrayOf<&dh_gate::F_Ho_B, dh_gate>,
                   "(6,) the wrench that is shown, N·m and N.")
      .def_ro("scale", &dh_gate::scale,
              "Share of the newest wrench that is shown, 0 to 1.")
      .def_prop_ro("rejected", &dh_gate_rejected,
                   "Number of packets refused so far.")
      .def_prop_ro("counts", &Counts, "Number of packets by verdict.")
      // Drake copies the values in a state.
      .def("__deepcopy__",
           [](const dh_gate& gate, nb::handle) { return gate; });
}

}  // namespace drake_haptics
