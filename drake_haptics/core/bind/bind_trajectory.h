#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <cstddef>

/// Loops over the poses of a trajectory, without the GIL.
namespace drake_haptics {

using Clock = std::chrono::steady_clock;

/// Time from `start` until now, s.
inline double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Calls step(k) for k from 0 to count - 1. Checks for interrupts between
/// steps, ten times a second.
template <typename Step>
void RunTrajectory(std::size_t count, const Step& step) {
  Clock::time_point checked = Clock::now();
  for (std::size_t k = 0; k < count; ++k) {
    step(k);
    if (SecondsSince(checked) < 0.1) continue;
    {
      const nanobind::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
    }
    checked = Clock::now();
  }
}

}  // namespace drake_haptics
