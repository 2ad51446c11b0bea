#include "device/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace drake_haptics {

bool RequestRealtimePriority() {
  sched_param parameters{};
  // Above the default of other such threads, below the kernel's own.
  parameters.sched_priority = sched_get_priority_min(SCHED_FIFO) + 10;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool RequestLockedMemory(const void* begin, std::size_t size) {
  return mlock(begin, size) == 0;
}

}  // namespace drake_haptics
