#include "device/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>

#include <utility>

namespace drake_haptics {
namespace {

// Blocks all signals while it lives, so that threads started meanwhile get
// none.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

}  // namespace

bool RequestRealtimePriority(int level) {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_FIFO) + level;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool RequestLockedMemory(const void* begin, std::size_t size) {
  return mlock(begin, size) == 0;
}

void ServoThread::Start(std::function<void()> serve) {
  const BlockedSignals blocked;
  thread_ = std::thread(std::move(serve));
}

void ServoThread::Close() {
  closing_.store(true);
  if (getpid() != process_) {
    // A forked process has our memory, but neither the thread nor a holder of
    // the lock.
    if (thread_.joinable()) thread_.detach();
    return;
  }
  const std::lock_guard lock(joining_);
  if (thread_.joinable()) thread_.join();
}

}  // namespace drake_haptics
