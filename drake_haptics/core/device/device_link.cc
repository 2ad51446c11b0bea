#include "device/device_link.h"

#include <algorithm>
#include <cmath>

#include "drake_haptics/wire.h"

namespace drake_haptics {
namespace {

// A driver's quaternion may be this far from unit length; it is normalized.
constexpr double kUnit = 1e-3;

template <std::size_t size>
bool IsFinite(const std::array<double, size>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

// Normalizes the pose. Returns false if it is not a pose or other values are
// not finite.
bool MakeUsable(HandleState* state) {
  auto& X = state->X;
  const double norm =
      std::hypot(std::hypot(X[0], X[1]), std::hypot(X[2], X[3]));
  if (!(IsFinite(X) && IsFinite(state->V) && IsFinite(state->F) &&
        std::abs(norm - 1) <= kUnit)) {
    return false;
  }
  for (int i = 0; i < 4; ++i) X[i] /= norm;
  return true;
}

}  // namespace

bool DeviceLink::Take(std::span<const unsigned char> packet, double now) {
  dh_state raw;
  if (dh_unpack_state(packet.data(), packet.size(), &raw) != DH_ACCEPTED) {
    ++counts_.damaged;
    return false;
  }
  HandleState state;
  state.sequence = raw.sequence;
  state.time = 1e-9 * static_cast<double>(raw.time_ns);
  std::copy_n(raw.X_BH, 7, state.X.begin());
  std::copy_n(raw.V_BH, 6, state.V.begin());
  std::copy_n(raw.F_Ho_B, 6, state.F.begin());
  state.max_force = raw.max_force_N;
  state.max_torque = raw.max_torque_Nm;
  state.buttons = raw.buttons;
  if (!MakeUsable(&state)) {
    ++counts_.not_finite;
    return false;
  }
  if (!AcceptBoot(raw.boot)) return false;
  ++counts_.received;
  if (window_.Accept(raw.sequence) != SequenceWindow::Arrival::kNewest) {
    return false;
  }
  state.number = state_.number + 1;
  state_ = state;
  counts_.refused = raw.rejected;
  device_gate_ = raw.gate;
  device_fault_ = raw.fault;
  is_heard_ = true;
  heard_at_ = now;
  Follow();
  return true;
}

// Each run of a driver has its own boot number. A packet of the run before is
// late, and not another restart.
bool DeviceLink::AcceptBoot(std::uint32_t boot) {
  if (boot == boot_) return true;
  if (boot == boot_before_ && boot_ != 0) {
    ++counts_.late;
    return false;
  }
  if (boot_ != 0) {
    ++counts_.restarts;
    if (mode_ == Mode::kActive) Latch(DH_FAULT_DEVICE);
  }
  boot_before_ = boot_;
  boot_ = boot;
  window_.Restart();
  return true;
}

void DeviceLink::Tick(double now) {
  if (is_heard_ && now - heard_at_ > longest_silence_) {
    is_heard_ = false;
    ++counts_.silences;
    if (mode_ == Mode::kActive) Latch(DH_FAULT_STALE);
    Follow();
  }
}

void DeviceLink::Recover() {
  if (mode_ == Mode::kLatched) mode_ = Mode::kWaiting;
  Follow();
}

void DeviceLink::Latch(std::uint8_t fault) {
  mode_ = Mode::kLatched;
  latched_fault_ = fault;
  Follow();
}

// Updates the mode from the device's gate, and the gate and fault in `state_`.
void DeviceLink::Follow() {
  if (mode_ == Mode::kActive && device_gate_ == DH_FAULT) {
    mode_ = Mode::kLatched;
    latched_fault_ = device_fault_;
  } else if (mode_ == Mode::kWaiting && asked_ && is_heard_ &&
             device_gate_ == DH_IDLE) {
    mode_ = Mode::kActive;
  }
  // A driver that is to recover may still be silent: then its last gate no
  // longer holds.
  const bool is_gone =
      mode_ == Mode::kWaiting && !is_heard_ && latched_fault_ != DH_FAULT_NONE;
  const bool at_fault = mode_ == Mode::kLatched || is_gone;
  state_.gate = device_gate_;
  state_.fault = device_fault_;
  if (at_fault) {
    state_.gate = DH_FAULT;
    state_.fault = latched_fault_;
  }
}

bool DeviceLink::IsEnabling() const {
  // A device at fault stays so, for all to see, until `Recover`: a command that
  // disables it would clear the fault.
  const bool leaves_fault =
      mode_ == Mode::kLatched && is_heard_ && device_gate_ == DH_FAULT;
  return mode_ == Mode::kActive || leaves_fault;
}

LinkCounts DeviceLink::counts() const {
  LinkCounts counts = counts_;
  counts.lost = window_.num_lost();
  counts.late += window_.num_late();
  counts.duplicate = window_.num_duplicate();
  return counts;
}

}  // namespace drake_haptics
