#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

#include "bind/bind.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

// Mean of the middle half of many readings, which is free of interruptions and
// finer than a tick of the clock.
double ClockInterval() {
  using Clock = std::chrono::steady_clock;
  constexpr int kReadings = 20000;
  std::vector<double> intervals(kReadings);
  for (double& interval : intervals) {
    const auto start = Clock::now();
    interval = std::chrono::duration<double>(Clock::now() - start).count();
  }
  std::sort(intervals.begin(), intervals.end());
  const auto begin = intervals.begin() + kReadings / 4;
  const auto end = intervals.end() - kReadings / 4;
  return std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
}

}  // namespace

void BindClock(nb::module_& m) {
  m.def("clock_interval", &ClockInterval,
        "Seconds between two readings of the clock that times queries, with "
        "nothing between them. Each timed query includes it.");
}

}  // namespace drake_haptics
