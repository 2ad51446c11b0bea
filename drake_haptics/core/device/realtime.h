#pragma once

#include <signal.h>

#include <cstddef>

namespace drake_haptics {

/// Asks the system to run the calling thread before all others that are not of
/// this kind (SCHED_FIFO).
/// @param level above the default of such threads, and below the kernel's own.
/// @returns whether it was granted, which usually needs a privilege.
bool RequestRealtimePriority(int level);

/// Asks the system to keep memory from being paged out.
/// @returns whether it was granted.
bool RequestLockedMemory(const void* begin, std::size_t size);

/// Blocks all signals while it lives: a thread that is started then gets none.
/// They are for the interpreter's thread, which would else sleep on.
class BlockedSignals {
 public:
  BlockedSignals();
  ~BlockedSignals();

 private:
  sigset_t before_;
};

}  // namespace drake_haptics
