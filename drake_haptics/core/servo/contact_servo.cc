#include "servo/contact_servo.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

namespace drake_haptics {
namespace {

// Below the UdpServo's priority, which must answer while this thread solves.
constexpr int kPriority = 9;

}  // namespace

ContactServo::ContactServo(UdpServo* servo, ServoTool tool)
    : servo_(servo), tool_(std::move(tool)), clock_(tool_.period()) {
  report_.is_running = true;
  Report();
  thread_.Start([this] { Run(); });
}

ContactServo::~ContactServo() { Close(); }

void ContactServo::Renew(const CouplingGains& gains, const Vec6& F_applied) {
  PlainLoad load{
      gains.stiffness,          gains.damping,   gains.rotational_stiffness,
      gains.rotational_damping, gains.max_force, gains.max_torque};
  std::copy_n(F_applied.data(), 6, load.data() + 6);
  load[12] = share_;
  load[13] = servo_->Now();
  load_box_.Write(load);
}

ToolState ContactServo::tool() {
  tool_box_.ReadNewer(&tool_seen_, &read_tool_);
  return {Eigen::Map<const PoseVector>(read_tool_.data()),
          Eigen::Map<const Vec6>(read_tool_.data() + 7)};
}

ContactServoStatus ContactServo::status() {
  status_box_.ReadNewer(&status_seen_, &status_);
  return status_;
}

void ContactServo::Run() {
  RequestRealtimePriority(kPriority);
  try {
    Serve();
  } catch (...) {
    // Out of memory. No wrench is published any more, so that the servo
    // releases the force, and the status says that the thread has ended.
  }
  report_.is_running = false;
  Report();
}

void ContactServo::Serve() {
  while (!thread_.IsClosing()) {
    const double rest = clock_.EndTurn(servo_->Now());
    std::this_thread::sleep_for(std::chrono::duration<double>(rest));
    load_box_.ReadNewer(&load_seen_, &load_);
    servo_->ReadNewer(&handle_seen_, &handle_);
    if (load_seen_ > 0 && handle_.number > 0) Solve();
    Report();
  }
}

void ContactServo::Solve() {
  tool_.SetGains({load_[0], load_[1], load_[2], load_[3], load_[4], load_[5]});
  try {
    LocalWrench wrench =
        tool_.Step(Eigen::Map<const PoseVector>(handle_.X.data()),
                   Eigen::Map<const Vec6>(handle_.V.data()),
                   Eigen::Map<const Vec6>(load_.data() + 6));
    wrench.F *= load_[12];
    wrench.K *= load_[12];
    wrench.B *= load_[12];
    servo_->Publish(wrench, load_[13]);
    ++report_.num_solved;
  } catch (const std::invalid_argument&) {
    // The handle's pose is not one: the last wrench is held and then released.
    ++report_.num_refused;
  }
}

void ContactServo::Report() {
  report_.num_late = clock_.num_late();
  status_box_.Write(report_);
  PlainTool plain;
  std::copy_n(tool_.state().q_WT.data(), 7, plain.data());
  std::copy_n(tool_.state().V_WT.data(), 6, plain.data() + 7);
  tool_box_.Write(plain);
}

}  // namespace drake_haptics
