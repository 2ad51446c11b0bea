#include "wrench_limit.h"

#include <cmath>

namespace drake_haptics {
namespace {

// The norm rounded once, of numbers of any size; NaN or infinite if one is.
double Norm(const Vec3& v) {
  const double size = v.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  if (size == 0 || !std::isfinite(size)) return size;
  const int exponent = std::ilogb(size);
  long double sum = 0;
  for (const double x : v) {
    const long double scaled = std::scalbn(x, -exponent);
    sum += scaled * scaled;
  }
  return std::scalbn(static_cast<double>(std::sqrt(sum)), exponent);
}

bool Exceeds(double norm, double largest) { return !(norm <= largest); }

}  // namespace

LimitedWrench LimitWrench(const Vec6& F, double max_torque, double max_force) {
  const double torque = Norm(F.head<3>()), force = Norm(F.tail<3>());
  if (!Exceeds(torque, max_torque) && !Exceeds(force, max_force)) {
    return {F, WrenchFate::kAsAsked};
  }
  if (!F.allFinite()) return {};
  LimitedWrench limited{F, WrenchFate::kLimited};
  // Divided first: the norm of huge values may be infinite, their ratios to it
  // are not.
  if (Exceeds(torque, max_torque)) {
    limited.F.head<3>() = max_torque * (F.head<3>() / torque);
  }
  if (Exceeds(force, max_force)) {
    limited.F.tail<3>() = max_force * (F.tail<3>() / force);
  }
  return limited;
}

}  // namespace drake_haptics
