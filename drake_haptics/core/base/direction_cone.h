#pragma once

#include "base/types.h"

namespace drake_haptics {

/// Directions within an angle of an axis.
struct DirectionCone {
  Vec3 axis = Vec3::UnitX();  ///< unit
  double cosine = -1;         ///< cosine of the angle; −1 for all directions

  /// Whether the cone contains a unit direction, or misses it by a cosine of
  /// `slack`. A cone of all directions contains each in spite of round-off.
  bool Holds(const Vec3& direction, double slack = 0) const {
    constexpr double kRoundOff = 1e-14;
    return axis.dot(direction) >= cosine - slack - kRoundOff;
  }
};

}  // namespace drake_haptics
