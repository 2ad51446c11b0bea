#include <nanobind/stl/string.h>

#include <array>
#include <cstdint>

#include "bind/bind.h"
#include "bind/bind_device.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

nb::bytes PackState(nb::int_ sequence, nb::int_ time_ns, nb::handle X_BH,
                    nb::handle V_BH, nb::handle F_Ho_B, nb::int_ boot,
                    nb::int_ session, nb::int_ command_sequence,
                    nb::int_ buttons, nb::int_ rejected, double max_force_N,
                    double max_torque_Nm, nb::int_ gate, nb::int_ fault) {
  dh_state state{};
  ReadCount("session", session, &state.session);
  ReadCount("sequence", sequence, &state.sequence);
  ReadCount("time_ns", time_ns, &state.time_ns);
  ReadReals(X_BH, "X_BH", state.X_BH);
  ReadReals(V_BH, "V_BH", state.V_BH);
  ReadReals(F_Ho_B, "F_Ho_B", state.F_Ho_B);
  ReadCount("boot", boot, &state.boot, 1);
  ReadCount("command_sequence", command_sequence, &state.command_sequence);
  ReadCount("buttons", buttons, &state.buttons);
  ReadCount("rejected", rejected, &state.rejected);
  state.max_force_N = static_cast<float>(max_force_N);
  state.max_torque_Nm = static_cast<float>(max_torque_Nm);
  ReadCount("gate", gate, &state.gate, 0, DH_FAULT);
  ReadCount("fault", fault, &state.fault, 0, DH_FAULT_DEVICE);
  std::array<std::uint8_t, DH_STATE_SIZE> bytes;
  dh_pack_state(&state, bytes.data());
  return nb::bytes(bytes.data(), bytes.size());
}

nb::bytes PackCommand(nb::int_ session, nb::int_ sequence, nb::int_ time_ns,
                      nb::handle F_Ho_B, nb::int_ state_sequence,
                      nb::int_ ttl_us, bool enable) {
  dh_command command{};
  ReadCount("session", session, &command.session, 1);
  ReadCount("sequence", sequence, &command.sequence);
  ReadCount("time_ns", time_ns, &command.time_ns);
  ReadReals(F_Ho_B, "F_Ho_B", command.F_Ho_B);
  ReadCount("state_sequence", state_sequence, &command.state_sequence);
  ReadCount("ttl_us", ttl_us, &command.ttl_us);
  command.enable = enable;
  std::array<std::uint8_t, DH_COMMAND_SIZE> bytes;
  dh_pack_command(&command, bytes.data());
  return nb::bytes(bytes.data(), bytes.size());
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

}  // namespace

void BindPackets(nb::module_& m) {
  nb::class_<dh_state>(m, "DeviceStatePacket",
                       "Packet that a driver sends (docs/device-protocol.md): "
                       "the handle H in the frame B of the device's base, SI.")
      .def_ro("session", &dh_state::session,
              "Session of the host that is served, or 0.")
      .def_ro("sequence", &dh_state::sequence,
              "Number of the packet; rises by one, and wraps.")
      .def_ro("time_ns", &dh_state::time_ns,
              "Time of the sample by the driver's clock, ns.")
      .def_prop_ro("X_BH", &ArrayOf<&dh_state::X_BH, dh_state>,
                   "(7,) pose [qw qx qy qz x y z], m.")
      .def_prop_ro("V_BH", &ArrayOf<&dh_state::V_BH, dh_state>,
                   "(6,) spatial velocity [ω; v], rad/s and m/s.")
      .def_prop_ro("F_Ho_B", &ArrayOf<&dh_state::F_Ho_B, dh_state>,
                   "(6,) wrench shown [τ; f] at Ho, N·m and N.")
      .def_ro("boot", &dh_state::boot,
              "Number that is random in each run of the driver.")
      .def_ro("command_sequence", &dh_state::command_sequence,
              "Number of the newest command that was accepted.")
      .def_ro("buttons", &dh_state::buttons, "Bit i: button i is held.")
      .def_ro("rejected", &dh_state::rejected,
              "Number of packets refused so far.")
      .def_ro("max_force_N", &dh_state::max_force_N, "Largest force, N.")
      .def_ro("max_torque_Nm", &dh_state::max_torque_Nm, "Largest torque, N·m.")
      .def_ro("gate", &dh_state::gate,
              "State, a number of `backend.GateState`.")
      .def_ro("fault", &dh_state::fault, "Fault, a number of `backend.Fault`.");
  nb::class_<dh_command>(
      m, "DeviceCommandPacket",
      "Packet that a host sends (docs/device-protocol.md), SI.")
      .def_ro("session", &dh_command::session,
              "Number that is random in each run of the host.")
      .def_ro("sequence", &dh_command::sequence,
              "Number of the packet; rises by one, and wraps.")
      .def_ro("time_ns", &dh_command::time_ns,
              "Time of sending by the host's clock, ns.")
      .def_prop_ro("F_Ho_B", &ArrayOf<&dh_command::F_Ho_B, dh_command>,
                   "(6,) wrench to show [τ; f] at Ho in B, N·m and N.")
      .def_ro("state_sequence", &dh_command::state_sequence,
              "Number of the state that this answers.")
      .def_ro("ttl_us", &dh_command::ttl_us, "Time to live, µs.")
      .def_prop_ro(
          "enable", [](const dh_command& c) { return c.enable != 0; },
          "Whether to show force.");
  m.def("pack_state", &PackState, nb::kw_only(), nb::arg("sequence"),
        nb::arg("time_ns"), nb::arg("X_BH"), nb::arg("V_BH"), nb::arg("F_Ho_B"),
        nb::arg("boot"), nb::arg("session"), nb::arg("command_sequence"),
        nb::arg("buttons"), nb::arg("rejected"), nb::arg("max_force_N"),
        nb::arg("max_torque_Nm"), nb::arg("gate"), nb::arg("fault"),
        "The 208 bytes of a state packet; the arguments are the attributes of "
        "`DeviceStatePacket`.\n\n"
        "Raises:\n"
        "    ValueError: a number does not fit, or a shape is wrong.");
  m.def(
      "unpack_state",
      [](const nb::bytes& packet) { return Unpack(&dh_unpack_state, packet); },
      nb::arg("packet"),
      "Reads a state packet. Its real numbers may be NaN or infinite.\n\n"
      "Raises:\n"
      "    ValueError: it is damaged or not a state packet; the message names "
      "the check that failed.");
  m.def("pack_command", &PackCommand, nb::kw_only(), nb::arg("session"),
        nb::arg("sequence"), nb::arg("time_ns"), nb::arg("F_Ho_B"),
        nb::arg("state_sequence"), nb::arg("ttl_us"), nb::arg("enable"),
        "The 88 bytes of a command packet; the arguments are the attributes of "
        "`DeviceCommandPacket`.\n\n"
        "Raises:\n"
        "    ValueError: a number does not fit, or a shape is wrong.");
  m.def(
      "unpack_command",
      [](const nb::bytes& packet) {
        return Unpack(&dh_unpack_command, packet);
      },
      nb::arg("packet"),
      "Reads a command packet. Its wrench may be NaN or infinite.\n\n"
      "Raises:\n"
      "    ValueError: it is damaged or not a command packet; the message "
      "names the check that failed.");
}

}  // namespace drake_haptics
