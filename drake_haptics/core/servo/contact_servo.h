#pragma once

#include <array>
#include <cstdint>

#include "device/realtime.h"
#include "device/seqlock.h"
#include "device/udp_servo.h"
#include "servo/period_clock.h"
#include "servo/servo_tool.h"

namespace drake_haptics {

/// Counters and state of a ContactServo at one moment.
struct ContactServoStatus {
  std::int64_t num_solved = 0;   ///< periods in which contact was solved
  std::int64_t num_late = 0;     ///< periods that were overrun
  std::int64_t num_refused = 0;  ///< handle states that were refused
  bool is_running = false;       ///< whether the thread runs
};

/// Solves contact for a UdpServo on its own thread, in each period with the
/// device's newest handle state. It publishes the local wrench to the servo as
/// a slower loop would, so that the servo never waits: when a period is
/// overrun, the servo answers with the linear wrench of the last one.
///
/// The loop calls `Renew` in each of its ticks. The wrench has the time of that
/// call, so that the servo releases the force when the loop stalls.
class ContactServo {
 public:
  /// Starts the thread, which waits for the first `Renew`.
  /// @param servo servo that outlives this; nothing else may publish to it.
  ContactServo(UdpServo* servo, ServoTool tool);
  ~ContactServo();

  /// Goes on, with these gains and this wrench from now on. One thread only.
  /// @param F_applied sum of the other wrenches on the tool at To in W.
  void Renew(const CouplingGains& gains, const Vec6& F_applied);

  /// Sets the share of the wrench that is shown from the next `Renew` on; 1 at
  /// first. Only on the thread of `Renew`.
  void SetShare(double share) { share_ = share; }

  /// Newest state of the tool. One thread only.
  ToolState tool();

  /// Newest status. One thread only.
  ContactServoStatus status();

  /// Ends the thread; later calls do nothing. Any thread.
  void Close() { thread_.Close(); }

 private:
  // [gains, F_applied, share, time] and [pose, velocity] as plain memory, which
  // can cross threads.
  using PlainLoad = std::array<double, 6 + 6 + 1 + 1>;
  using PlainTool = std::array<double, 7 + 6>;

  void Run();
  void Serve();
  void Solve();
  void Report();

  UdpServo* const servo_;

  // Written for the servo's thread.
  Seqlock<PlainLoad> load_box_;

  // Written by the servo's thread.
  Seqlock<PlainTool> tool_box_;
  Seqlock<ContactServoStatus> status_box_;

  // Used only by the thread that renews and reads.
  double share_ = 1;
  PlainTool read_tool_{};
  std::uint64_t tool_seen_ = 0;
  ContactServoStatus status_;
  std::uint64_t status_seen_ = 0;

  // Used only by the servo's thread.
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
