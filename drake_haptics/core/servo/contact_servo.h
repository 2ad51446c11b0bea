#pragma once

#include <array>
#include <cstdint>

#include "device/realtime.h"
#include "device/seqlock.h"
#include "device/udp_servo.h"
#include "servo/period_clock.h"
#include "servo/servo_tool.h"

namespace drake_haptics {

/// What a ContactServo has done, at one moment.
struct ContactServoStatus {
  std::int64_t num_solved = 0;   ///< periods
  std::int64_t num_late = 0;     ///< periods that took longer than one
  std::int64_t num_refused = 0;  ///< handles that could not be solved for
  bool is_running = false;       ///< not closed
};

/// Solves contact for a UdpServo on a thread of its own, in each of its
/// periods with the device's newest handle. It gives the servo the local wrench
/// as a slower loop would. So the servo never waits for it: where a period is
/// overrun, the servo answers by the linear wrench of the last one.
///
/// The loop says in each of its ticks that it goes on, by `Renew`. Its time is
/// that of the wrench: where the loop stalls, the servo releases as ever.
class ContactServo {
 public:
  /// Starts to wait for the first `Renew`.
  /// @param servo outlives this; nobody else may publish to it.
  ContactServo(UdpServo* servo, ServoTool tool);
  ~ContactServo();

  /// Goes on, with these from now on. One thread only.
  /// @param F_applied other wrenches on the tool at To in W.
  void Renew(const CouplingGains& gains, const Vec6& F_applied);

  /// Part of the wrench that is shown, from the next `Renew` on; 1 at first.
  /// The thread of `Renew` only.
  void SetShare(double share) { share_ = share; }

  /// The tool, newest. One thread only.
  ToolState tool();

  /// One thread only.
  ContactServoStatus status();

  /// Ends the thread; later calls do nothing. Any thread.
  void Close() { thread_.Close(); }

 private:
  // Gains, F_applied, share, time; pose and velocity: plain memory crosses
  // threads.
  using PlainLoad = std::array<double, 6 + 6 + 1 + 1>;
  using PlainTool = std::array<double, 7 + 6>;

  void Run();
  void Serve();
  void Solve();
  void Report();

  UdpServo* const servo_;

  // To the thread.
  Seqlock<PlainLoad> load_box_;

  // From the thread.
  Seqlock<PlainTool> tool_box_;
  Seqlock<ContactServoStatus> status_box_;

  // Of the one thread that renews and reads.
  double share_ = 1;
  PlainTool read_tool_{};
  std::uint64_t tool_seen_ = 0;
  ContactServoStatus status_;
  std::uint64_t status_seen_ = 0;

  // Of the thread alone.
  ServoTool tool_;
  PeriodClock clock_;
  PlainLoad load_{};
  std::uint64_t load_seen_ = 0;
  HandleState handle_;
  std::uint64_t handle_seen_ = 0;
  ContactServoStatus report_;

  ServoThread thread_;
};

}  // namespace drake_haptics
