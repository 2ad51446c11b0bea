#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/sequence_window.h"

namespace drake_haptics {

/// What a device last told of itself, in its base frame: see `wire.h`. Plain
/// memory, so that it can cross threads.
struct HandleState {
  std::int64_t number = 0;     ///< rises, also when the driver is restarted
  std::uint32_t sequence = 0;  ///< as sent
  double time = 0;             ///< s, the driver's clock
  std::array<double, 7> X{1};  ///< [qw qx qy qz x y z], m
  std::array<double, 6> V{};   ///< [ω; v], rad/s and m/s
  std::array<double, 6> F{};   ///< shown, [τ; f], N·m and N
  double max_force = 0;        ///< N
  double max_torque = 0;       ///< N·m
  std::uint32_t buttons = 0;
  std::uint8_t gate = 0;
  std::uint8_t fault = 0;
};

/// What became of packets and drivers, counted from the start.
struct LinkCounts {
  std::int64_t received = 0;    ///< states taken or late
  std::int64_t lost = 0;        ///< never came, by the gaps
  std::int64_t late = 0;        ///< came after a newer one; not used
  std::int64_t duplicate = 0;   ///< came before
  std::int64_t damaged = 0;     ///< not a whole state of this version
  std::int64_t not_finite = 0;  ///< a state that says no pose or velocity
  std::int64_t restarts = 0;    ///< of the driver
  std::int64_t silences = 0;    ///< so long that the driver counts as gone
  std::int64_t refused = 0;     ///< of our commands, as the driver counts
};

/// The host's side of the way to a driver: which states count, and whether the
/// device is to be enabled. Time is an argument.
///
/// A device is enabled only from its idle state, and only while a wrench is
/// asked for. A fault of the device, its driver's restart and its silence are
/// each latched until `Recover`.
class DeviceLink {
 public:
  /// @param longest_silence s after which the device counts as gone. The device
  ///        itself ends its force much sooner, by the commands' time to live,
  ///        and may go on by itself after a short pause.
  explicit DeviceLink(double longest_silence)
      : longest_silence_(longest_silence) {}

  /// Takes a packet from the driver that came at `now`, s.
  /// @returns whether it is a newer state than the last.
  bool Take(std::span<const unsigned char> packet, double now);

  /// Looks at the clock: a driver may have been silent for too long.
  void Tick(double now);

  /// A wrench is asked for from now on.
  void QueryPair() { asked_ = true; }

  /// Takes up again after a fault: disabled until the device is idle.
  void Recover();

  /// Whether the command that is sent now is to enable the device.
  bool IsEnabling() const;

  /// Whether a wrench may be shown.
  bool IsActive() const { return mode_ == Mode::kActive; }

  /// Whether states are coming.
  bool IsHeard() const { return is_heard_; }

  /// The newest state, with the gate and fault that hold on this side of the
  /// way; its `number` is 0 before the first.
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
