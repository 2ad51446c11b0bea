#include "base/wrench_limit.h"

#include <cmath>

namespace drake_haptics {
namespace {

// Norm of numbers of any size, rounded once like Python's math.hypot; NaN or
// infinite if a number is.
double Norm(const Vec3& v) {
  const double size = v.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  if (size == 0 || !std::isfinite(size)) return size;
  const int exponent = std::ilogb(size);
  // Sum of squares, and its rounding error.
  double sum = 0, lost = 0;
  for (const double x : v) {
    const double scaled = std::scalbn(x, -exponent);
    const double square = scaled * scaled;
    const double next = sum + square, added = next - sum;
    lost += std::fma(scaled, scaled, -square);
    lost += (sum - (next - added)) + (square - added);
    sum = next;
  }
  const double root = std::sqrt(sum);
  const double rest = std::fma(-root, root, sum) + lost;
  return std::scalbn(root + rest / (2 * root), exponent);
}

bool Exceeds(double norm, double largest) { return !(norm <= largest); }

// Includes norms that were shortened to the limit before, and rounded.
bool Reaches(double norm, double largest) {
  constexpr double kRounding = 1e-12;
  return norm != 0 && Exceeds(norm, (1 - kRounding) * largest);
}

}  // namespace

LimitedWrench LimitWrench(const Vec6& F, double max_torque, double max_force) {
  const double torque = Norm(F.head<3>()), force = Norm(F.tail<3>());
  if (!Reaches(torque, max_torque) && !Reaches(force, max_force)) {
    return {F, WrenchFate::kAsAsked};
  }
  if (!F.allFinite()) return {};
  LimitedWrench limited{F, WrenchFate::kLimited};
  // Divided first: a limit times a huge value may be infinite.
  if (Exceeds(torque, max_torque)) {
    limited.F.head<3>() = max_torque * (F.head<3>() / torque);
  }
  if (Exceeds(force, max_force)) {
    limited.F.tail<3>() = max_force * (F.tail<3>() / force);
  }
  return limited;
}

}  // namespace drake_haptics
