#pragma once

#include <cstdint>

#include "base/rotation.h"
#include "base/types.h"

namespace drake_haptics {

/// A wrench on the handle with its local linear model:
/// F(X, V) = F₀ − K δ − B (V − V₀), δ = [rotation vector; translation] from X₀
/// to X. All are at the handle's origin Ho in one frame; [torque; force], N·m,
/// N.
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

/// Times of holding, releasing and engaging a wrench, s.
struct ServoTimes {
  double hold = 0.02;     ///< in full force without renewal
  double release = 0.02;  ///< then from full force to none
  double engage = 0.2;    ///< from none to full force after renewal

  /// @throws std::invalid_argument unless all are finite and above zero.
  void Check() const;
};

/// Computes the wrench that a fast loop shows between the ticks of a slow one:
/// the last local wrench, within limits, and zero if it is not renewed. Time is
/// an argument; the law has no clock and no thread.
///
/// With s the share of the wrench that is shown,
/// F = limit(s limit(F(X, V)) − 4 s (1 − s) D V). The damping D acts only
/// between no force and full force: a released handle has drifted, and a spring
/// that engages undamped would throw it back. docs/servo.md has measurements.
class ServoLaw {
 public:
  /// @throws std::invalid_argument unless the times are finite and above zero.
  explicit ServoLaw(const ServoTimes& times);

  /// Sets the largest norms of force and torque that `Step` returns, N and N·m;
  /// both are zero before. Negative limits and NaN count as zero.
  void SetLimits(double max_force, double max_torque);

  /// Takes a new wrench. Only the passive parts of K and B act; see
  /// `ProjectToPositiveSemidefinite`. A wrench that is not finite ends all
  /// force at once.
  void Adopt(const LocalWrench& wrench);

  /// Returns the wrench to show at the time `now` (s), with the handle at pose
  /// X and velocity V; zero at once if these are not finite.
  Vec6 Step(double now, const PoseVector& X, const Vec6& V);

  /// Ends all force at once; the wrench engages from zero at the next step.
  void Release();

  /// Share of the wrench that is shown, from 0 to 1.
  double scale() const { return scale_; }
  /// Number of wrenches and states that were not finite.
  std::int64_t num_not_finite() const { return num_not_finite_; }
  /// Number of wrenches whose K or B was not passive.
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
