#pragma once

#include <cstdint>

#include "base/rotation.h"
#include "base/types.h"

namespace drake_haptics {

/// A wrench on the handle, and how it changes as the handle moves on:
/// F(X, V) = F₀ − K δ − B (V − V₀), δ = [rotation vector; translation] from X₀
/// to X. All at the handle's origin Ho in one frame; [torque; force], N·m, N.
struct LocalWrench {
  Vec6 F = Vec6::Zero();
  PoseVector X = PoseVector::Unit(0);
  Vec6 V = Vec6::Zero();
  Mat6 K = Mat6::Zero();
  Mat6 B = Mat6::Zero();
  double published_at = 0;  ///< s, by the clock of `ServoLaw::Step`

  bool IsFinite() const {
    return F.allFinite() && X.allFinite() && V.allFinite() && K.allFinite() &&
           B.allFinite();
  }
};

/// How long a wrench is shown that is not renewed, s.
struct ServoTimes {
  double hold = 0.02;     ///< in full
  double release = 0.02;  ///< from full force to none after that
  double engage = 0.2;    ///< from none to full force when it is renewed

  /// @throws std::invalid_argument unless all are finite and above zero.
  void Check() const;
};

/// What a fast loop shows between the ticks of a slow one: the last local
/// wrench, within limits, and nothing once it is not renewed. Time is an
/// argument; the law knows no clock and no thread.
///
/// With s the part of the wrench that is shown, F = limit(s limit(F(X, V)) −
/// 4 s (1 − s) D V). The damping D acts on the way between none and all of the
/// force only: a handle that was released has drifted, and would be thrown
/// back by a spring that engages undamped. docs/servo.md has measurements.
class ServoLaw {
 public:
  /// @throws std::invalid_argument unless the times are finite and above zero.
  explicit ServoLaw(const ServoTimes& times);

  /// Largest norms that `Step` answers with, N and N·m: none before this is
  /// called. What is negative or NaN counts as zero.
  void SetLimits(double max_force, double max_torque);

  /// Takes a new wrench. Of K and B only the passive part acts; see
  /// `ProjectToPositiveSemidefinite`. One that is not finite ends all force at
  /// once.
  void Adopt(const LocalWrench& wrench);

  /// The wrench to show now, s, with the handle at X moving at V. Zero, at
  /// once, where these are not finite.
  Vec6 Step(double now, const PoseVector& X, const Vec6& V);

  /// Ends all force at once; the wrench engages from zero at the next step.
  void Release();

  /// Part of the wrench that is shown, from 0 to 1.
  double scale() const { return scale_; }
  /// Wrenches and states that were not finite.
  std::int64_t num_not_finite() const { return num_not_finite_; }
  /// Wrenches whose K or B was not passive.
  std::int64_t num_not_passive() const { return num_not_passive_; }

 private:
  void Refuse();
  Vec6 Limit(const Vec6& F) const;
  Vec6 Extrapolate(const PoseVector& X, const Vec6& V) const;
  void Slew(double now);

  ServoTimes times_;
  double max_force_ = 0;
  double max_torque_ = 0;
  LocalWrench wrench_;
  bool has_wrench_ = false;
  double scale_ = 0;
  double slewed_at_ = 0;
  bool has_slewed_ = false;
  std::int64_t num_not_finite_ = 0;
  std::int64_t num_not_passive_ = 0;
};

}  // namespace drake_haptics
