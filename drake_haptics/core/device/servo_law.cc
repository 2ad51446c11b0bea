#include "device/servo_law.h"

#include <algorithm>

#include "base/positive_semidefinite.h"
#include "base/require.h"
#include "base/wrench_limit.h"

namespace drake_haptics {
namespace {

// Longest time step for the rise of the force, s: a pause of the fast loop
// counts as no more.
constexpr double kLargestRise = 2e-3;
// Damping half-way between no force and full force, N·m·s/rad and N·s/m: the
// smallest that the device presets recommend, which any device can show.
constexpr double kTurnBrake = 4e-3;
constexpr double kBrake = 4;

Vec6 Brake(const Vec6& V) {
  Vec6 F;
  F << kTurnBrake * V.head<3>(), kBrake * V.tail<3>();
  return F;
}

}  // namespace

void ServoTimes::Check() const {
  RequirePositive(hold, "hold_s");
  RequirePositive(release, "release_s");
  RequirePositive(engage, "engage_s");
}

ServoLaw::ServoLaw(const ServoTimes& times) : times_(times) { times.Check(); }

void ServoLaw::SetLimits(double max_force, double max_torque) {
  max_force_ = max_force > 0 ? max_force : 0;
  max_torque_ = max_torque > 0 ? max_torque : 0;
}

void ServoLaw::Adopt(const LocalWrench& wrench) {
  if (!wrench.IsFinite()) {
    Refuse();
    return;
  }
  bool changed = false;
  wrench_ = wrench;
  wrench_.K = ProjectToPositiveSemidefinite(wrench.K, &changed);
  wrench_.B = ProjectToPositiveSemidefinite(wrench.B, &changed);
  num_not_passive_ += changed;
  has_wrench_ = true;
}

void ServoLaw::Release() {
  has_slewed_ = false;
  scale_ = 0;
}

void ServoLaw::Refuse() {
  ++num_not_finite_;
  has_wrench_ = false;
  Release();
}

Vec6 ServoLaw::Step(double now, const PoseVector& X, const Vec6& V) {
  Slew(now);
  if (!has_wrench_) return Vec6::Zero();
  const Vec6 F = Extrapolate(X, V);
  const Vec6 braking = 4 * scale_ * (1 - scale_) * Brake(V);
  if (!F.allFinite() || !braking.allFinite()) {
    Refuse();
    return Vec6::Zero();
  }
  return Limit(scale_ * Limit(F) - braking);
}

Vec6 ServoLaw::Limit(const Vec6& F) const {
  return LimitWrench(F, max_torque_, max_force_).F;
}

Vec6 ServoLaw::Extrapolate(const PoseVector& X, const Vec6& V) const {
  return wrench_.F - wrench_.K * Displacement(wrench_.X, X) -
         wrench_.B * (V - wrench_.V);
}

void ServoLaw::Slew(double now) {
  const double step = has_slewed_ ? std::max(0.0, now - slewed_at_) : 0;
  slewed_at_ = now;
  has_slewed_ = true;
  const bool is_fresh =
      has_wrench_ && now - wrench_.published_at <= times_.hold;
  const double rise = std::min(step, kLargestRise) / times_.engage;
  scale_ = is_fresh ? std::min(1.0, scale_ + rise)
                    : std::max(0.0, scale_ - step / times_.release);
}

}  // namespace drake_haptics
