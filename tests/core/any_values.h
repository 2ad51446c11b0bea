// Wrenches and poses of any size, and the limits that are tested with them.
#pragma once

#include <cmath>
#include <limits>
#include <random>

#include "base/types.h"

namespace drake_haptics {

constexpr double kMaxForce = 8.5, kMaxTorque = 0.5;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline std::mt19937 generator(0);

/// Of any size, and now and then no number at all.
inline double Anything() {
  const int kind = static_cast<int>(generator() % 40);
  if (kind == 0) return kNaN;
  if (kind == 1) return -kInfinity;
  const double share = std::uniform_real_distribution<double>(-1, 1)(generator);
  return kind < 4 ? share * std::numeric_limits<double>::max()
                  : share * std::exp2(static_cast<int>(generator() % 80) - 40);
}

template <typename Values>
Values Any() {
  return Values::NullaryExpr([] { return Anything(); });
}

inline bool IsWithin(const Vec6& F) {
  return F.head<3>().norm() <= kMaxTorque * (1 + 1e-12) &&
         F.tail<3>().norm() <= kMaxForce * (1 + 1e-12);
}

}  // namespace drake_haptics
