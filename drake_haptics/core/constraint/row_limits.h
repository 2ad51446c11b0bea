#pragma once

#include "base/autodiff.h"

namespace drake_haptics {

/// At so much, m/s, a row leads back into its skin.
inline constexpr double kBackSpeed = 0.02;

/// What the springs of a row demand of a motion ξ: they push where aᵀ ξ is
/// less.
///
/// Apart, a row does not come nearer than its skin, or than it is: the tick's
/// beginning meets that wherever the object does not come closer, so that a
/// hard row never pushes by itself. What is missing of the skin, and what an
/// object comes closer by, a second spring makes up for. In overlap there is
/// that one alone, and weak.
template <typename T>
struct RowLimits {
  T kept;    ///< of the spring that holds, m
  T wanted;  ///< of the one that leads back, m

  /// @param distance of the row, m.
  /// @param nearest distance of its pieces, m: of a plane that was turned they
  ///     are farther than it tells.
  /// @param closer what the object's point comes closer by in the tick, m.
  /// @param back the most that the second spring makes up for in a tick, m.
  RowLimits(const T& distance, const T& nearest, const T& closer, double skin,
            double back) {
    const T missing = skin - (distance < nearest ? nearest : distance);
    kept = T(0.0);
    if (distance > skin) kept += skin - distance;
    if (closer < 0.0) kept += closer;
    wanted = closer + (missing < back ? missing : T(back));
  }
};

}  // namespace drake_haptics
