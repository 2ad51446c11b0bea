#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/sequence_window.h"

namespace drake_haptics {

/// Last state that a device sent, in its base frame; see `wire.h`. It is plain
/// memory, which can cross threads.
struct HandleState {
  std::int64_t number = 0;     ///< rises, also across restarts of the driver
  std::uint32_t sequence = 0;  ///< number of the packet, as sent
  double time = 0;             ///< time by the driver's clock, s
  std::array<double, 7> X{1};  ///< [qw qx qy qz x y z], m
  std::array<double, 6> V{};   ///< [ω; v], rad/s and m/s
  std::array<double, 6> F{};   ///< wrench shown, [τ; f], N·m and N
  double max_force = 0;        ///< limit of the device, N
  double max_torque = 0;       ///< limit of the device, N·m
  std::uint32_t buttons = 0;
  std::uint8_t gate = 0;
  std::uint8_t fault = 0;
};

/// Counts of packets and of the driver's restarts and silences, from the start.
struct LinkCounts {
  std::int64_t received = 0;    ///< valid states, late and duplicate ones too
  std::int64_t lost = 0;        ///< states that never came, by the gaps
  std::int64_t late = 0;        ///< states after a newer one; not used
  std::int64_t duplicate = 0;   ///< states that had come before
  std::int64_t damaged = 0;     ///< not a whole state of this version
  std::int64_t not_finite = 0;  ///< states with an invalid pose or value
  std::int64_t restarts = 0;    ///< restarts of the driver
  std::int64_t silences = 0;    ///< silences that made the driver count as gone
  std::int64_t refused = 0;     ///< packets refused, by the driver's count
};

/// The host's side of the link to a driver: decides which states count, and
/// whether to enable the device. Time is an argument.
///
/// A device is enabled only from its idle state, and only after a wrench was
/// requested. A fault of the device, its driver's restart and its silence are
/// each latched until `Recover`.
class DeviceLink {
 public:
  /// @param longest_silence silence after which the device counts as gone, s.
  ///     The device itself ends its force much sooner, by the commands' time to
  ///     live, and may go on by itself after a short pause.
  explicit DeviceLink(double longest_silence)
      : longest_silence_(longest_silence) {}

  /// Takes a packet that came from the driver at `now`, s.
  /// @returns whether it is a newer state than the last.
  bool Take(std::span<const unsigned char> packet, double now);

  /// Checks at `now`, s, whether the driver has been silent for too long.
  void Tick(double now);

  /// Requests a wrench, which lets the device be enabled from now on.
  void RequestWrench() { asked_ = true; }

  /// Recovers from a fault: disabled until the device is idle.
  void Recover();

  /// Whether a command sent now should enable the device.
  bool IsEnabling() const;

  /// Whether a wrench may be shown.
  bool IsActive() const { return mode_ == Mode::kActive; }

  /// Whether states are coming.
  bool IsHeard() const { return is_heard_; }

  /// The newest state, with the gate and fault that hold on the host's side;
  /// its `number` is 0 before the first.
  const HandleState& state() const { return state_; }

  LinkCounts counts() const;

 private:
  enum class Mode { kWaiting, kActive, kLatched };

  void Latch(std::uint8_t fault);
  bool AcceptBoot(std::uint32_t boot);
  void Follow();

  double longest_silence_;
  Mode mode_ = Mode::kWaiting;
  bool asked_ = false;
  bool is_heard_ = false;
  double heard_at_ = 0;
  std::uint8_t device_gate_ = 0;
  std::uint8_t device_fault_ = 0;
  std::uint8_t latched_fault_ = 0;
  std::uint32_t boot_ = 0;
  std::uint32_t boot_before_ = 0;
  SequenceWindow window_;
  HandleState state_;
  LinkCounts counts_;
};

}  // namespace drake_haptics
