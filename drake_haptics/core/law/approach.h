#pragma once

#include <algorithm>
#include <cmath>

#include "base/autodiff.h"

namespace drake_haptics {

/// Approach speed for a damper that works on approach only. At rest it works in
/// half of all small motions, and its linearization is the mean of both halves.
template <typename T>
struct Approach {
  /// Surfaces slower than this are at rest, m/s.
  static constexpr double kAtRest = 1e-9;

  double engaged;  ///< weight: 1 on approach, ½ at rest, 0 on parting
  T speed;         ///< m/s, at most 0

  /// @param v speed at which the surfaces part, m/s.
  explicit Approach(const T& v) {
    const double value = ValueOf(v);
    engaged = std::abs(value) < kAtRest ? 0.5 : value < 0 ? 1.0 : 0.0;
    speed = engaged * v + (std::min(value, 0.0) - engaged * value);
  }
};

}  // namespace drake_haptics
