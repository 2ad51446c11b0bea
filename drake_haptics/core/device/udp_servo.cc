#include "device/udp_servo.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "base/require.h"
#include "drake_haptics/wire.h"

namespace drake_haptics {
namespace {

constexpr double kHandshakePeriod = 0.05;  // s, of commands to a silent driver
constexpr double kSilence = 0.5;           // s, after which a driver is gone
constexpr double kPatience = 0.01;         // s, longest wait for a packet
constexpr int kMostPackets = 256;          // packets taken at once
constexpr int kPriority = 10;
constexpr int kDisables = 5;  // disabling commands at the end, in case of loss
constexpr auto kDisablePause = std::chrono::milliseconds(4);

std::uint32_t DrawSession() {
  std::random_device random;
  std::uint32_t session = 0;
  while (session == 0) session = static_cast<std::uint32_t>(random());
  return session;
}

}  // namespace

void UdpServoOptions::Check() const {
  RequirePositive(time_to_live, "ttl_s");
  RequirePositive(max_rate, "max_rate_hz");
  if (!(max_force >= 0 && max_torque >= 0)) {
    throw std::invalid_argument(
        "max_force_N and max_torque_Nm must be at least 0, are " +
        std::to_string(max_force) + " and " + std::to_string(max_torque));
  }
  times.Check();
}

UdpServo::UdpServo(const std::string& host, std::uint16_t port,
                   const UdpServoOptions& options)
    : options_((options.Check(), options)),
      session_(DrawSession()),
      epoch_(std::chrono::steady_clock::now()),
      socket_(host, port),
      link_(std::max(kSilence, 2 * options.time_to_live)),
      law_(options.times) {
  report_.is_running = true;
  Report();
  thread_.Start([this] { Run(); });
}

UdpServo::~UdpServo() { Close(); }

HandleState UdpServo::Read() {
  state_box_.ReadNewer(&read_seen_, &read_);
  return read_;
}

UdpServoStatus UdpServo::status() {
  status_box_.ReadNewer(&status_seen_, &status_);
  return status_;
}

void UdpServo::Publish(const LocalWrench& wrench, double time) {
  PlainWrench plain;
  double* out = plain.data();
  const auto append = [&out](const auto& values) {
    out = std::copy_n(values.data(), values.size(), out);
  };
  append(wrench.F);
  append(wrench.X);
  append(wrench.V);
  append(wrench.K);
  append(wrench.B);
  *out = time;
  wrench_box_.Write(plain);
}

void UdpServo::Recover() { recover_.store(true); }

double UdpServo::Now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                       epoch_)
      .count();
}

void UdpServo::Run() {
  report_.has_priority = RequestRealtimePriority(kPriority);
  report_.has_locked_memory = RequestLockedMemory(this, sizeof(*this));
  try {
    Serve();
  } catch (...) {
    // Nothing here throws by design. If it does, the device ends at zero force
    // and the status says that the thread has ended.
  }
  Disable();
  report_.is_running = false;
  Report();
}

void UdpServo::Serve() {
  while (!thread_.IsClosing()) {
    socket_.Wait(kPatience);
    const double rest = allowed_at_ - Now();
    if (rest > 0) {
      std::this_thread::sleep_for(std::chrono::duration<double>(rest));
    }
    const bool renewed = Drain();
    link_.Tick(Now());
    TakeRequests();
    const bool is_silent = Now() - sent_at_ >= kHandshakePeriod;
    if (renewed || sent_at_ < 0 || (is_silent && !link_.IsActive())) Answer();
    if (renewed) RecordLateness();
    Report();
  }
}

// Takes all waiting packets; only the newest state is answered.
bool UdpServo::Drain() {
  std::array<unsigned char, 512> buffer;
  bool renewed = false;
  for (int i = 0; i < kMostPackets; ++i) {
    const std::ptrdiff_t size = socket_.Receive(buffer);
    if (size < 0) break;
    const std::span packet(buffer.data(), static_cast<std::size_t>(size));
    renewed |= link_.Take(packet, Now());
  }
  return renewed;
}

void UdpServo::TakeRequests() {
  PlainWrench plain;
  if (wrench_box_.ReadNewer(&wrench_seen_, &plain)) {
    const double* in = plain.data();
    const auto take = [&in](auto* values) {
      std::copy_n(in, values->size(), values->data());
      in += values->size();
    };
    LocalWrench wrench;
    take(&wrench.F);
    take(&wrench.X);
    take(&wrench.V);
    take(&wrench.K);
    take(&wrench.B);
    wrench.published_at = *in;
    law_.Adopt(wrench);
    link_.RequestWrench();
  }
  if (recover_.exchange(false)) link_.Recover();
}

void UdpServo::Answer() {
  const HandleState& state = link_.state();
  Vec6 F = Vec6::Zero();
  if (link_.IsActive()) {
    // In this order std::min keeps the device's NaN, which lets no force
    // through.
    law_.SetLimits(std::min(state.max_force, options_.max_force),
                   std::min(state.max_torque, options_.max_torque));
    F = law_.Step(Now(), Eigen::Map<const PoseVector>(state.X.data()),
                  Eigen::Map<const Vec6>(state.V.data()));
  } else {
    law_.Release();
  }
  Send(F, link_.IsEnabling());
}

void UdpServo::RecordLateness() {
  const std::int64_t restarts = link_.counts().restarts;
  if (restarts != restarts_) answer_lateness_.Restart();
  restarts_ = restarts;
  lateness_.Record(answer_lateness_.Measure(link_.state().time, sent_at_));
}

void UdpServo::Send(const Vec6& F, bool enable) {
  dh_command command{};
  command.session = session_;
  command.sequence = ++sequence_;
  command.time_ns = static_cast<std::uint64_t>(1e9 * Now());
  std::copy_n(F.data(), 6, command.F_Ho_B);
  command.state_sequence = link_.state().sequence;
  command.ttl_us = static_cast<std::uint32_t>(
      std::clamp(1e6 * options_.time_to_live, 1.0, 4e9));
  command.enable = enable;
  std::array<unsigned char, DH_COMMAND_SIZE> packet;
  dh_pack_command(&command, packet.data());
  socket_.Send(packet);
  sent_at_ = Now();
  // A state may come early by one period, so that jitter at the largest rate
  // does not delay the answers.
  const double period = 1 / options_.max_rate;
  allowed_at_ = std::max(allowed_at_, sent_at_ - period) + period;
  ++report_.sent;
}

void UdpServo::Disable() {
  for (int i = 0; i < kDisables; ++i) {
    Send(Vec6::Zero(), false);
    std::this_thread::sleep_for(kDisablePause);
  }
}

void UdpServo::Report() {
  report_.counts = link_.counts();
  report_.num_not_finite = law_.num_not_finite();
  report_.num_not_passive = law_.num_not_passive();
  report_.scale = law_.scale();
  report_.is_heard = link_.IsHeard();
  report_.is_active = link_.IsActive();
  status_box_.Write(report_);
  state_box_.Write(link_.state());
}

}  // namespace drake_haptics
