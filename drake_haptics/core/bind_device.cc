#include <drake_haptics/gate.h>
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "bind.h"
#include "bind_real_array.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

/// @throws std::invalid_argument unless the value is `size` real numbers.
template <std::size_t size>
void ReadReals(nb::handle value, const char* name, double (&out)[size]) {
  const RealArray array(value, name);
  if (array.ndim() != 1 || array.shape(0) != static_cast<Py_ssize_t>(size)) {
    throw std::invalid_argument(std::string(name) + " must be (" +
                                std::to_string(size) + ",); got shape " +
                                array.shape_text());
  }
  for (std::size_t i = 0; i < size; ++i) {
    out[i] = RealArray::Load(array.data() +
                             static_cast<Py_ssize_t>(i) * array.stride(0));
  }
}

template <std::size_t size>
Eigen::Matrix<double, static_cast<int>(size), 1> ToArray(
    const double (&values)[size]) {
  return Eigen::Map<const Eigen::Matrix<double, static_cast<int>(size), 1>>(
      values);
}

/// @throws std::invalid_argument unless low <= value <= high.
template <typename Out>
Out ReadCount(const char* name, nb::int_ value, std::uint64_t low,
              std::uint64_t high) {
  std::uint64_t count = 0;
  const bool fits = nb::try_cast(value, count) && count >= low && count <= high;
  if (!fits) {
    throw std::invalid_argument(std::string(name) + " must be from " +
                                std::to_string(low) + " to " +
                                std::to_string(high) + ", got " +
                                nb::cast<std::string>(nb::str(value)));
  }
  return static_cast<Out>(count);
}

constexpr std::uint64_t kMax32 = UINT32_MAX, kMax64 = UINT64_MAX;

nb::bytes PackState(nb::int_ sequence, nb::int_ time_ns, nb::handle X_BH,
                    nb::handle V_BH, nb::handle F_BH, nb::int_ boot,
                    nb::int_ session, nb::int_ command_sequence,
                    nb::int_ buttons, nb::int_ rejected, double max_force_N,
                    double max_torque_Nm, nb::int_ gate, nb::int_ fault) {
  dh_state state{};
  state.session = ReadCount<std::uint32_t>("session", session, 0, kMax32);
  state.sequence = ReadCount<std::uint32_t>("sequence", sequence, 0, kMax32);
  state.time_ns = ReadCount<std::uint64_t>("time_ns", time_ns, 0, kMax64);
  ReadReals(X_BH, "X_BH", state.X_BH);
  ReadReals(V_BH, "V_BH", state.V_BH);
  ReadReals(F_BH, "F_BH", state.F_BH);
  state.boot = ReadCount<std::uint32_t>("boot", boot, 1, kMax32);
  state.command_sequence =
      ReadCount<std::uint32_t>("command_sequence", command_sequence, 0, kMax32);
  state.buttons = ReadCount<std::uint32_t>("buttons", buttons, 0, kMax32);
  state.rejected = ReadCount<std::uint32_t>("rejected", rejected, 0, kMax32);
  state.max_force_N = static_cast<float>(max_force_N);
  state.max_torque_Nm = static_cast<float>(max_torque_Nm);
  state.gate = ReadCount<std::uint8_t>("gate", gate, 0, DH_FAULT);
  state.fault = ReadCount<std::uint8_t>("fault", fault, 0, DH_FAULT_DEVICE);
  std::array<std::uint8_t, DH_STATE_SIZE> bytes;
  dh_pack_state(&state, bytes.data());
  return nb::bytes(bytes.data(), bytes.size());
}

nb::bytes PackCommand(nb::int_ session, nb::int_ sequence, nb::int_ time_ns,
                      nb::handle F_BH, nb::int_ state_sequence, nb::int_ ttl_us,
                      bool enable) {
  dh_command command{};
  command.session = ReadCount<std::uint32_t>("session", session, 1, kMax32);
  command.sequence = ReadCount<std::uint32_t>("sequence", sequence, 0, kMax32);
  command.time_ns = ReadCount<std::uint64_t>("time_ns", time_ns, 0, kMax64);
  ReadReals(F_BH, "F_BH", command.F_BH);
  command.state_sequence =
      ReadCount<std::uint32_t>("state_sequence", state_sequence, 0, kMax32);
  command.ttl_us = ReadCount<std::uint32_t>("ttl_us", ttl_us, 0, kMax32);
  command.enable = enable;
  std::array<std::uint8_t, DH_COMMAND_SIZE> bytes;
  dh_pack_command(&command, bytes.data());
  return nb::bytes(bytes.data(), bytes.size());
}

const std::uint8_t* Data(const nb::bytes& bytes) {
  return static_cast<const std::uint8_t*>(bytes.data());
}

const char* NameOf(dh_verdict verdict) {
  static constexpr const char* kNames[DH_VERDICT_COUNT] = {
      "accepted",      "too_short",          "wrong_magic",
      "wrong_version", "wrong_kind",         "wrong_size",
      "wrong_crc",     "wrong_field",        "foreign_session",
      "old_sequence",  "not_disabled_first", "at_fault",
      "not_finite",    "clock_went_back"};
  return kNames[verdict];
}

template <typename Packet>
Packet Unpack(dh_verdict (*unpack)(const std::uint8_t*, std::size_t, Packet*),
              const nb::bytes& bytes) {
  Packet packet{};
  const dh_verdict verdict = unpack(Data(bytes), bytes.size(), &packet);
  if (verdict != DH_ACCEPTED) {
    throw std::invalid_argument(std::string("packet refused: ") +
                                NameOf(verdict));
  }
  return packet;
}

void BindPackets(nb::module_& m) {
  nb::class_<dh_state>(m, "DeviceStatePacket",
                       "What a driver sends (docs/device-protocol.md). The "
                       "handle H in the frame B of the device's base, SI.")
      .def_ro("session", &dh_state::session, "Host that is served, or 0.")
      .def_ro("sequence", &dh_state::sequence, "Rises by one, and wraps.")
      .def_ro("time_ns", &dh_state::time_ns, "Of the sample, driver's clock.")
      .def_prop_ro(
          "X_BH", [](const dh_state& s) { return ToArray(s.X_BH); },
          "(7,) pose [qw qx qy qz x y z], m.")
      .def_prop_ro(
          "V_BH", [](const dh_state& s) { return ToArray(s.V_BH); },
          "(6,) spatial velocity [ω; v], rad/s and m/s.")
      .def_prop_ro(
          "F_BH", [](const dh_state& s) { return ToArray(s.F_BH); },
          "(6,) wrench shown [τ; f] at Ho, N·m and N.")
      .def_ro("boot", &dh_state::boot, "Random in each run of the driver.")
      .def_ro("command_sequence", &dh_state::command_sequence,
              "Of the newest command that was accepted.")
      .def_ro("buttons", &dh_state::buttons, "Bit i: button i is held.")
      .def_ro("rejected", &dh_state::rejected, "Packets refused so far.")
      .def_ro("max_force_N", &dh_state::max_force_N, "Largest force, N.")
      .def_ro("max_torque_Nm", &dh_state::max_torque_Nm, "Largest torque, N·m.")
      .def_ro("gate", &dh_state::gate, "As `backend.GateState`.")
      .def_ro("fault", &dh_state::fault, "As `backend.Fault`.");
  nb::class_<dh_command>(m, "DeviceCommandPacket",
                         "What a host sends (docs/device-protocol.md), SI.")
      .def_ro("session", &dh_command::session, "Random in each run of it.")
      .def_ro("sequence", &dh_command::sequence, "Rises by one, and wraps.")
      .def_ro("time_ns", &dh_command::time_ns, "Of sending, host's clock.")
      .def_prop_ro(
          "F_BH", [](const dh_command& c) { return ToArray(c.F_BH); },
          "(6,) wrench to show [τ; f] at Ho in B, N·m and N.")
      .def_ro("state_sequence", &dh_command::state_sequence,
              "Of the state that this answers.")
      .def_ro("ttl_us", &dh_command::ttl_us, "Time to live, µs.")
      .def_prop_ro(
          "enable", [](const dh_command& c) { return c.enable != 0; },
          "Whether force is to be shown.");
  m.def("pack_state", &PackState, nb::kw_only(), nb::arg("sequence"),
        nb::arg("time_ns"), nb::arg("X_BH"), nb::arg("V_BH"), nb::arg("F_BH"),
        nb::arg("boot"), nb::arg("session"), nb::arg("command_sequence"),
        nb::arg("buttons"), nb::arg("rejected"), nb::arg("max_force_N"),
        nb::arg("max_torque_Nm"), nb::arg("gate"), nb::arg("fault"),
        "The 208 bytes of a state packet; the arguments are the attributes of "
        "`DeviceStatePacket`.\n\n"
        "Raises:\n"
        "    ValueError: a number does not fit its field, or a wrong shape.");
  m.def(
      "unpack_state",
      [](const nb::bytes& packet) { return Unpack(&dh_unpack_state, packet); },
      nb::arg("packet"),
      "What a state packet says. Its real numbers may be NaN or infinite.\n\n"
      "Raises:\n"
      "    ValueError: it is damaged or none; says which check failed.");
  m.def("pack_command", &PackCommand, nb::kw_only(), nb::arg("session"),
        nb::arg("sequence"), nb::arg("time_ns"), nb::arg("F_BH"),
        nb::arg("state_sequence"), nb::arg("ttl_us"), nb::arg("enable"),
        "The 88 bytes of a command packet; the arguments are the attributes of "
        "`DeviceCommandPacket`.\n\n"
        "Raises:\n"
        "    ValueError: a number does not fit its field, or a wrong shape.");
  m.def(
      "unpack_command",
      [](const nb::bytes& packet) {
        return Unpack(&dh_unpack_command, packet);
      },
      nb::arg("packet"),
      "What a command packet says. Its wrench may be NaN or infinite.\n\n"
      "Raises:\n"
      "    ValueError: it is damaged or none; says which check failed.");
}

dh_gate MakeGate(double max_force_N, double max_torque_Nm,
                 double max_speed_m_per_s, double max_turn_rate_rad_per_s,
                 double ramp_in_s, double ramp_out_s, double max_ttl_s) {
  const dh_gate_limits limits{
      max_force_N, max_torque_Nm, max_speed_m_per_s, max_turn_rate_rad_per_s,
      ramp_in_s,   ramp_out_s,    max_ttl_s};
  dh_gate gate;
  if (!dh_gate_init(&gate, &limits)) {
    throw std::invalid_argument(
        "a gate needs max_force_N and max_torque_Nm of at least 0, "
        "max_speed_m_per_s and max_turn_rate_rad_per_s above 0, ramp_in_s from "
        "0.001 to 10, ramp_out_s from 0.001 to 1 and max_ttl_s from 1e-6 to 1; "
        "got " +
        std::to_string(max_force_N) + ", " + std::to_string(max_torque_Nm) +
        ", " + std::to_string(max_speed_m_per_s) + ", " +
        std::to_string(max_turn_rate_rad_per_s) + ", " +
        std::to_string(ramp_in_s) + ", " + std::to_string(ramp_out_s) +
        " and " + std::to_string(max_ttl_s));
  }
  return gate;
}

Eigen::Matrix<double, 6, 1> Step(dh_gate* gate, std::uint64_t now_ns,
                                 nb::handle X_BH, nb::handle V_BH) {
  double X[7], V[6], F[6];
  ReadReals(X_BH, "X_BH", X);
  ReadReals(V_BH, "V_BH", V);
  dh_gate_step(gate, now_ns, X, V, F);
  return ToArray(F);
}

std::map<std::string, std::uint64_t> Counts(const dh_gate& gate) {
  std::map<std::string, std::uint64_t> counts;
  for (int i = 0; i < DH_VERDICT_COUNT; ++i) {
    counts[NameOf(static_cast<dh_verdict>(i))] = gate.counts[i];
  }
  return counts;
}

void BindGate(nb::module_& m) {
  const dh_gate_limits usual = dh_gate_default_limits(0, 0);
  nb::class_<dh_gate>(
      m, "DeviceGate",
      "What stands between commands and a hand, in the driver's process: the "
      "state machine of gate.h (docs/device-protocol.md), time as an argument. "
      "Force and torque never exceed the limits, in any state.")
      .def(
          "__init__",
          [](dh_gate* self, double max_force_N, double max_torque_Nm,
             double max_speed_m_per_s, double max_turn_rate_rad_per_s,
             double ramp_in_s, double ramp_out_s, double max_ttl_s) {
            new (self) dh_gate(MakeGate(
                max_force_N, max_torque_Nm, max_speed_m_per_s,
                max_turn_rate_rad_per_s, ramp_in_s, ramp_out_s, max_ttl_s));
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
          "    max_speed_m_per_s: A faster handle is a fault while active.\n"
          "    max_turn_rate_rad_per_s: Likewise for its turning.\n"
          "    ramp_in_s: From none to full, 0.001 to 10 s.\n"
          "    ramp_out_s: From full to none, 0.001 to 1 s.\n"
          "    max_ttl_s: The longest that a command lives, 1e-6 to 1 s.\n\n"
          "Raises:\n"
          "    ValueError: a limit is not finite or out of its bounds.")
      .def(
          "receive",
          [](dh_gate& gate, std::uint64_t now_ns, const nb::bytes& data) {
            return NameOf(
                dh_gate_receive(&gate, now_ns, Data(data), data.size()));
          },
          nb::arg("now_ns"), nb::arg("data"),
          "Takes a packet in, whatever it holds.\n\n"
          "Args:\n"
          "    now_ns: The driver's monotonic clock, ns.\n"
          "    data: The datagram.\n\n"
          "Returns:\n"
          "    'accepted', or why not: a key of `counts`.")
      .def("step", &Step, nb::arg("now_ns"), nb::arg("X_BH"), nb::arg("V_BH"),
           "Moves the time on; once per tick, after the packets.\n\n"
           "Args:\n"
           "    now_ns: The driver's monotonic clock, ns.\n"
           "    X_BH: (7,) the handle's pose [qw qx qy qz x y z], m. A value "
           "that is not finite is a fault.\n"
           "    V_BH: (6,) its spatial velocity [ω; v], rad/s and m/s; "
           "likewise.\n\n"
           "Returns:\n"
           "    (6,) the wrench to show [τ; f] at Ho in B, N·m and N.\n\n"
           "Raises:\n"
           "    ValueError: X_BH or V_BH has a wrong shape.")
      .def(
          "fail", [](dh_gate& gate) { dh_gate_fail(&gate); },
          "The driver's own hardware is at fault: zero wrench at once.")
      .def_prop_ro(
          "state", [](const dh_gate& gate) { return int{gate.state}; },
          "As `backend.GateState`.")
      .def_prop_ro(
          "fault", [](const dh_gate& gate) { return int{gate.fault}; },
          "As `backend.Fault`.")
      .def_ro("session", &dh_gate::session, "Host that is served, or 0.")
      .def_ro("command_sequence", &dh_gate::command_sequence,
              "Of the newest command that was accepted.")
      .def_prop_ro(
          "command_F_BH",
          [](const dh_gate& gate) { return ToArray(gate.command_F_BH); },
          "(6,) the newest wrench to show, within the limits, N·m and N.")
      .def_prop_ro(
          "F_BH", [](const dh_gate& gate) { return ToArray(gate.F_BH); },
          "(6,) the wrench that is shown, N·m and N.")
      .def_ro("scale", &dh_gate::scale, "Share of it that is shown, 0 to 1.")
      .def_prop_ro("rejected", &dh_gate_rejected, "Packets refused so far.")
      .def_prop_ro("counts", &Counts, "Packets by verdict.")
      // Drake copies what is in a state.
      .def("__deepcopy__",
           [](const dh_gate& gate, nb::handle) { return gate; });
}

}  // namespace

void BindDevice(nb::module_& m) {
  BindPackets(m);
  BindGate(m);
}

}  // namespace drake_haptics
