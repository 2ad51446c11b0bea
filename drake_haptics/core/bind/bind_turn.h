#pragma once

#include <nanobind/nanobind.h>

#include <mutex>
#include <optional>

/// Objects with a state between calls, used from several Python threads: the
/// calls take turns.
namespace drake_haptics {

/// Takes a turn for as long as it lives. No thread waits for a turn while
/// holding the GIL, so that the thread that has the turn can always get the
/// GIL.
class Turn {
 public:
  enum class Gil {
    kRelease,  ///< other threads run meanwhile
    /// For calls that last a tick at most: a busy Python thread takes a
    /// released GIL and keeps it for Python's switch interval, 5 ms.
    kHold
  };

  Turn(std::mutex* mutex, Gil gil) : lock_(*mutex, std::defer_lock) {
    if (gil == Gil::kHold && lock_.try_lock()) return;
    release_.emplace();
    lock_.lock();
  }

 private:
  // Destroyed in reverse order: the turn ends before the GIL is acquired again.
  std::optional<nanobind::gil_scoped_release> release_;
  std::unique_lock<std::mutex> lock_;
};

}  // namespace drake_haptics
