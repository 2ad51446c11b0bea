#include "rotation.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace drake_haptics {

Eigen::Quaterniond RotationExp(const Vec3& r) {
  const double angle = r.norm();
  // sin(x/2)/x, by its series where the quotient loses digits.
  const double s =
      angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * r.x(), s * r.y(), s * r.z()};
}

Vec3 RotationLog(const Eigen::Quaterniond& q) {
  // q and −q are the same rotation; take the one with the short way round.
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Vec3 v = sign * q.vec();
  const double s = v.norm();
  const double half = std::atan2(s, sign * q.w());
  return (s > 1e-12 ? 2 * half / s : 2.0) * v;
}

Pose PoseFromVector(const PoseVector& q, const char* what) {
  const double norm = q.head<4>().norm();
  if (!q.allFinite() || !(norm > 1e-6 && norm < 1e100)) {
    throw std::invalid_argument(
        std::string(what) +
        " must be finite values [qw qx qy qz x y z] with a quaternion that is "
        "not zero and not huge");
  }
  return {QuaternionOf(q).toRotationMatrix(), q.tail<3>()};
}

}  // namespace drake_haptics
