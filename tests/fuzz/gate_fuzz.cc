// Any bytes as a packet: refused, or the same bytes when packed again. Then a
// gate that hosts, a handle and a clock do anything to: never beyond its
// limits, never a force outside the active state, never for long after the last
// word.
#include <drake_haptics/gate.h>

#include <array>
#include <cmath>
#include <vector>

#include "byte_source.h"
#include "target.h"

namespace drake_haptics::fuzz {
namespace {

constexpr double kForce = 8.5, kTorque = 0.188;
constexpr std::uint64_t kMillisecond = 1'000'000;
constexpr std::array<double, 7> kPose{1, 0, 0, 0, 0, 0, 0};

using Bytes = std::vector<std::uint8_t>;

template <std::size_t size, typename Packet>
void CheckUnpacked(const Bytes& bytes,
                   dh_verdict (*unpack)(const std::uint8_t*, std::size_t,
                                        Packet*),
                   void (*pack)(const Packet*, std::uint8_t*), Tally* tally) {
  Packet packet{};
  if (unpack(bytes.data(), bytes.size(), &packet) != DH_ACCEPTED) {
    ++tally->refusals;
    return;
  }
  std::array<std::uint8_t, size> again;
  pack(&packet, again.data());
  if (!std::equal(bytes.begin(), bytes.end(), again.begin(), again.end())) {
    tally->Violated("the same bytes again", "%zu of them", bytes.size());
  }
}

class GateRun {
 public:
  GateRun(ByteSource* source, Tally* tally) : source_(source), tally_(tally) {
    dh_gate_limits limits = dh_gate_default_limits(kForce, kTorque);
    limits.ramp_in_s = 0.001 + 0.3 * std::abs(source->Unit());
    dh_gate_init(&gate_, &limits);
  }

  void Act() {
    ++tally_->queries;
    switch (source_->Choice(8)) {
      case 0:
        Receive(Damaged());
        break;
      case 1:
        now_ += source_->Flag() ? 1'000 * kMillisecond : 0;
        break;
      case 2:
        if (source_->Rarely(8)) dh_gate_fail(&gate_);
        if (source_->Rarely(16)) now_ -= now_ / 2;
        break;
      case 3:
      case 4:
        Receive(Command());
        break;
      default:
        Step();
    }
    Check();
  }

  // No host is heard any more.
  void FallSilent() {
    const double silence_s = gate_.limits.max_ttl_s + gate_.limits.ramp_out_s;
    for (int i = 0; i < 1000 * silence_s + 2; ++i) {
      now_ += kMillisecond;
      Show({});
    }
    if (gate_.state == DH_ACTIVE) {
      tally_->Violated("silence ends at zero", "scale %g", gate_.scale);
    }
  }

 private:
  double Real() {
    switch (source_->Choice(4)) {
      case 0:
        return 20 * source_->Unit();
      case 1:
        return source_->Unit() * source_->Power(-310, 0);
      case 2:
        return source_->Unit() * source_->Power(0, 308);
      default:
        return source_->Rarely(4) ? source_->AnyDouble() : 0;
    }
  }

  Bytes Command() {
    dh_command command{};
    command.session = 1 + source_->Choice(3);
    sequence_ += source_->Choice(5) - 1;
    command.sequence = sequence_;
    for (double& f : command.F_Ho_B) f = Real();
    command.ttl_us = source_->Flag() ? 20'000 : 1u << source_->Choice(32);
    command.enable = source_->Choice(4) > 0;
    Bytes bytes(DH_COMMAND_SIZE);
    dh_pack_command(&command, bytes.data());
    return bytes;
  }

  Bytes Damaged() {
    Bytes bytes = Command();
    bytes[source_->Choice(DH_COMMAND_SIZE)] ^= 1 << source_->Choice(8);
    bytes.resize(source_->Flag() ? source_->Byte() : bytes.size());
    return bytes;
  }

  void Receive(const Bytes& bytes) {
    dh_gate_receive(&gate_, now_, bytes.data(), bytes.size());
  }

  void Step() {
    now_ += kMillisecond * source_->Choice(3);
    std::array<double, 6> V{};
    for (double& v : V) v = source_->Rarely(64) ? Real() : source_->Unit();
    Show(V);
  }

  void Show(const std::array<double, 6>& V) {
    std::array<double, 6> F;
    dh_gate_step(&gate_, now_, kPose.data(), V.data(), F.data());
    if (std::memcmp(F.data(), gate_.F_Ho_B, sizeof gate_.F_Ho_B) != 0) {
      tally_->Violated("shows what it says", "%g N", F[5]);
    }
  }

  void Check() {
    const double* F = gate_.F_Ho_B;
    const double torque = std::hypot(F[0], F[1], F[2]);
    const double force = std::hypot(F[3], F[4], F[5]);
    if (!(torque <= kTorque && force <= kForce)) {
      tally_->Violated("limits", "%g Nm, %g N", torque, force);
    }
    if (gate_.state != DH_ACTIVE && (torque > 0 || force > 0)) {
      tally_->Violated("force only while active", "%g Nm, %g N", torque, force);
    }
    if (!(gate_.scale >= 0 && gate_.scale <= 1)) {
      tally_->Violated("a share", "%g", gate_.scale);
    }
  }

  ByteSource* source_;
  Tally* tally_;
  dh_gate gate_;
  std::uint64_t now_ = 0;
  std::uint32_t sequence_ = 0xfffffff0;
};

}  // namespace

void RunInput(std::span<const std::uint8_t> bytes, Tally* tally) {
  // A copy of its own, so that a sanitizer sees a look beyond its end.
  const Bytes packet(bytes.begin(), bytes.end());
  CheckUnpacked<DH_STATE_SIZE>(packet, &dh_unpack_state, &dh_pack_state, tally);
  CheckUnpacked<DH_COMMAND_SIZE>(packet, &dh_unpack_command, &dh_pack_command,
                                 tally);
  ByteSource source(bytes);
  GateRun run(&source, tally);
  do {
    run.Act();
  } while (!source.is_spent());
  run.FallSilent();
}

}  // namespace drake_haptics::fuzz
