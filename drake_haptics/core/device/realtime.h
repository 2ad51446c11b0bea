#pragma once

#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>

namespace drake_haptics {

/// Asks the system to run the calling thread before all threads without
/// real-time priority (SCHED_FIFO).
/// @param level priority, counted from the lowest of such threads; it must stay
///     below the kernel's own threads.
/// @returns whether it was granted, which usually needs a privilege.
bool RequestRealtimePriority(int level);

/// Asks the system to keep memory from being paged out.
/// @returns whether it was granted.
bool RequestLockedMemory(const void* begin, std::size_t size);

/// The thread of a servo. It gets no signals, which must reach the
/// interpreter's thread: that would otherwise sleep on.
class ServoThread {
 public:
  /// Runs `serve`, which must return soon after `IsClosing` is true. Called
  /// once.
  void Start(std::function<void()> serve);

  /// Whether the thread must end. Any thread.
  bool IsClosing() const { return closing_.load(std::memory_order_relaxed); }

  /// Ends the thread; later calls do nothing. Any thread.
  void Close();

 private:
  const pid_t process_ = getpid();
  std::atomic<bool> closing_{false};
  std::mutex joining_;
  std::thread thread_;
};

}  // namespace drake_haptics
