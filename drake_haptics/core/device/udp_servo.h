#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>

#include "device/device_link.h"
#include "device/lateness_histogram.h"
#include "device/realtime.h"
#include "device/seqlock.h"
#include "device/servo_law.h"
#include "device/udp_socket.h"

namespace drake_haptics {

struct UdpServoOptions {
  double time_to_live = 0.05;  ///< time that the device shows a command, s
  double max_rate = 4000;      ///< largest rate of commands, Hz
  /// Largest norms, N and N·m, where the device allows more.
  double max_force = std::numeric_limits<double>::infinity();
  double max_torque = std::numeric_limits<double>::infinity();
  ServoTimes times;

  /// @throws std::invalid_argument unless the times and the rate are finite and
  ///         above zero and no limit is negative or NaN.
  void Check() const;
};

/// Counters and state of a servo at one moment.
struct UdpServoStatus {
  LinkCounts counts;
  std::int64_t sent = 0;             ///< commands sent
  std::int64_t num_not_finite = 0;   ///< wrenches and states; see ServoLaw
  std::int64_t num_not_passive = 0;  ///< slopes; see ServoLaw
  double scale = 0;                  ///< share of the wrench that is sent
  bool is_running = false;           ///< whether the thread runs
  bool is_heard = false;             ///< whether states are coming
  bool is_active = false;            ///< whether a wrench may be shown
  bool has_priority = false;         ///< whether the thread is real-time
  bool has_locked_memory = false;    ///< whether it is locked in memory
};

/// Answers every state of a driver with a wrench from the last local wrench, on
/// its own thread. `Publish`, `Read` and `status` never wait for the thread,
/// nor does it wait for them. It has no clock: the driver's states are its
/// ticks. After a pause it answers only the newest state.
class UdpServo {
 public:
  /// Starts the thread, which looks for the driver.
  /// @throws std::invalid_argument for options out of range.
  /// @throws std::runtime_error if there is no such host, or no socket.
  UdpServo(const std::string& host, std::uint16_t port,
           const UdpServoOptions& options);
  ~UdpServo();

  /// The newest state; its `number` is 0 before the first. One thread only.
  HandleState Read();

  /// The newest state, for any number of threads, each with its own `seen`; 0
  /// at first.
  /// @returns whether `state` was replaced.
  bool ReadNewer(std::uint64_t* seen, HandleState* state) const {
    return state_box_.ReadNewer(seen, state);
  }

  /// Shows a wrench from now on; the first one enables the device. One thread
  /// only.
  void Publish(const LocalWrench& wrench) { Publish(wrench, Now()); }

  /// The same for a loop whose last tick was at `time` by our clock, s.
  void Publish(const LocalWrench& wrench, double time);

  /// Time by our clock, s. Any thread.
  double Now() const;

  /// Recovers from a fault.
  void Recover();

  /// Disables the device and ends the thread, in about 30 ms; later calls do
  /// nothing. Any thread.
  void Close() { thread_.Close(); }

  /// Newest status. One thread only.
  UdpServoStatus status();
  const LatenessHistogram& lateness() const { return lateness_; }
  std::uint16_t local_port() const { return socket_.local_port(); }

 private:
  // [F, X, V, K, B, time] as plain memory, which can cross threads.
  using PlainWrench = std::array<double, 6 + 7 + 6 + 36 + 36 + 1>;

  void Run();
  void Serve();
  bool Drain();
  void TakeRequests();
  void Answer();
  void RecordLateness();
  void Send(const Vec6& F, bool enable);
  void Disable();
  void Report();

  const UdpServoOptions options_;
  const std::uint32_t session_;
  const std::chrono::steady_clock::time_point epoch_;
  UdpSocket socket_;

  // Written for the servo's thread.
  Seqlock<PlainWrench> wrench_box_;
  std::atomic<bool> recover_{false};

  // Written by the servo's thread.
  Seqlock<HandleState> state_box_;
  Seqlock<UdpServoStatus> status_box_;
  LatenessHistogram lateness_;

  // Used only by the thread that reads.
  HandleState read_;
  std::uint64_t read_seen_ = 0;
  UdpServoStatus status_;
  std::uint64_t status_seen_ = 0;

  // Used only by the servo's thread.
  DeviceLink link_;
  ServoLaw law_;
  AnswerLateness answer_lateness_;
  std::uint64_t wrench_seen_ = 0;
  std::uint32_t sequence_ = 0;
  std::int64_t restarts_ = 0;
  double sent_at_ = -1;
  double allowed_at_ = 0;
  UdpServoStatus report_;

  ServoThread thread_;
};

}  // namespace drake_haptics
