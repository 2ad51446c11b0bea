#include "base/rotation.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace drake_haptics {

template <typename T>
Eigen::Quaternion<T> RotationExp(const Vec3Of<T>& r) {
  using std::cos, std::sin, std::sqrt;
  const T square = r.squaredNorm();
  // Series where the quotient loses digits, and the root its derivative.
  if (ValueOf(square) < 1e-8) {
    const T s = 0.5 - square / 48.0;
    return {T(1.0 - square / 8.0), T(s * r.x()), T(s * r.y()), T(s * r.z())};
  }
  const T angle = sqrt(square);
  const T s = sin(angle / 2.0) / angle;
  return {T(cos(angle / 2.0)), T(s * r.x()), T(s * r.y()), T(s * r.z())};
}

template <typename T>
Vec3Of<T> RotationLog(const Eigen::Quaternion<T>& q) {
  using std::atan2, std::sqrt;
  // q and −q are the same rotation; take the shorter way round.
  const double sign = ValueOf(q.w()) < 0 ? -1.0 : 1.0;
  const Vec3Of<T> v = sign * q.vec();
  const T w = sign * q.w();
  const T square = v.squaredNorm();
  if (ValueOf(square) < 1e-12) {
    return T((2.0 - 2.0 / 3.0 * square / (w * w)) / w) * v;
  }
  const T s = sqrt(square);
  return T(2.0 * atan2(s, w) / s) * v;
}

template Eigen::Quaterniond RotationExp<double>(const Vec3&);
template Eigen::Quaternion<AutoDiff> RotationExp<AutoDiff>(
    const Vec3Of<AutoDiff>&);
template Vec3 RotationLog<double>(const Eigen::Quaterniond&);
template Vec3Of<AutoDiff> RotationLog<AutoDiff>(
    const Eigen::Quaternion<AutoDiff>&);

Pose PoseFromVector(const PoseVector& q, const char* what) {
  const double norm = q.head<4>().norm();
  if (!q.allFinite() || !(norm > 1e-6 && norm < 1e100)) {
    throw std::invalid_argument(
        std::string(what) +
        " must be finite values [qw qx qy qz x y z] with a quaternion that is "
        "not zero and not huge");
  }
  return PoseOfVector(q);
}

}  // namespace drake_haptics
