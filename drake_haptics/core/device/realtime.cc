#include "device/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace drake_haptics {

bool RequestRealtimePriority(int level) {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_FIFO) + level;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool RequestLockedMemory(const void* begin, std::size_t size) {
  return mlock(begin, size) == 0;
}

BlockedSignals::BlockedSignals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before_);
}

BlockedSignals::~BlockedSignals() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace drake_haptics
