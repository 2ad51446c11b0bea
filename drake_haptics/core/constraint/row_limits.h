#pragma once

#include "base/autodiff.h"

namespace drake_haptics {

/// Speed at which a row leads back into its skin, m/s.
inline constexpr double kBackSpeed = 0.02;

/// Lower limits on aᵀ ξ, for a motion ξ, below which the springs of a row push.
///
/// A row of separate pieces must not come nearer than its skin, or than it is.
/// The tick's beginning meets this unless the object comes closer, so that a
/// hard row never pushes by itself. A second spring makes up for lost skin and
/// for the object's approach. In overlap there is only the second spring, and
/// it is weak.
template <typename T>
struct RowLimits {
  T kept;    ///< limit of the spring that holds, m
  T wanted;  ///< limit of the spring that leads back, m

  /// @param distance distance of the row, m.
  /// @param nearest distance of its pieces, m; larger than the row's if the
  ///     plane was turned.
  /// @param closer approach of the object's point in the tick, m.
  /// @param back largest distance that the second spring makes up for in a
  ///     tick, m.
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
