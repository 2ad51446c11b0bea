#pragma once

#include <cmath>

#include "base/types.h"

namespace drake_haptics {

/// Displacement of the points of a body A, seen from a body B.
class Motion {
 public:
  /// No motion.
  Motion() = default;

  /// Motion from one pose to the next. The difference of the positions is
  /// formed first, so that it is exact far from B's origin.
  Motion(const Pose& last_X_BA, const Pose& X_BA)
      : change_{X_BA.R - last_X_BA.R, X_BA.p - last_X_BA.p},
        // The Frobenius norm is 2√2 sin(θ/2) for a rotation by θ.
        turn_(change_.R.norm() * std::sqrt(0.5)) {}

  /// Bound on the displacement of the points of A within `radius` of `center`
  /// (in A's frame), m: a rotation by θ moves a point at distance r by at most
  /// 2 r sin(θ/2).
  double Bound(const Vec3& center, double radius) const {
    return (change_ * center).norm() + radius * turn_;
  }

  /// 2 sin(θ/2) for a rotation by θ; 1 for 60°.
  double turn() const { return turn_; }

 private:
  Pose change_{Mat3::Zero(), Vec3::Zero()};
  double turn_ = 0;
};

}  // namespace drake_haptics
