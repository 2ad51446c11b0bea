#pragma once

#include <Eigen/Geometry>

#include "base/autodiff.h"
#include "base/types.h"

namespace drake_haptics {

/// Rotation by the vector r (rad): exp of its cross-product matrix.
template <typename T>
Eigen::Quaternion<T> RotationExp(const Vec3Of<T>& r);

/// The rotation vector (rad) of q, of length at most π. Inverse of
/// RotationExp.
template <typename T>
Vec3Of<T> RotationLog(const Eigen::Quaternion<T>& q);

/// The pose without its derivatives.
inline Pose ValuesOf(const PoseOf<AutoDiff>& X) {
  return {ValuesOf(X.R), ValuesOf(X.p)};
}

/// A pose as Drake's vector [qw qx qy qz x y z].
template <typename T>
using PoseVectorOf = Eigen::Matrix<T, 7, 1>;
using PoseVector = PoseVectorOf<double>;

/// @throws std::invalid_argument unless all values are finite and the
///         quaternion can be normalized. `what` names the pose in the message.
Pose PoseFromVector(const PoseVector& q, const char* what);

/// The quaternion of a pose vector, normalized.
template <typename T>
Eigen::Quaternion<T> QuaternionOf(const Eigen::Matrix<T, 7, 1>& q) {
  return Eigen::Quaternion<T>(q[0], q[1], q[2], q[3]).normalized();
}

/// The pose of a pose vector.
template <typename T>
PoseOf<T> PoseOfVector(const Eigen::Matrix<T, 7, 1>& q) {
  return {QuaternionOf(q).toRotationMatrix(), q.template tail<3>()};
}

/// The pose after a motion [θ; t] of the frame's origin, rad and m.
template <typename T>
PoseOf<T> Displaced(const PoseOf<T>& X, const Eigen::Matrix<T, 6, 1>& motion) {
  const Vec3Of<T> turn = motion.template head<3>();
  return {RotationExp<T>(turn).toRotationMatrix() * X.R,
          X.p + motion.template tail<3>()};
}
template <typename T>
Eigen::Matrix<T, 7, 1> Displaced(const Eigen::Matrix<T, 7, 1>& q,
                                 const Eigen::Matrix<T, 6, 1>& motion) {
  const Vec3Of<T> turn = motion.template head<3>();
  const Eigen::Quaternion<T> R =
      (RotationExp<T>(turn) * QuaternionOf(q)).normalized();
  Eigen::Matrix<T, 7, 1> displaced;
  displaced << R.w(), R.vec(), q.template tail<3>() + motion.template tail<3>();
  return displaced;
}

/// The motion [θ; t] of the frame's origin from one pose to another, rad and m.
template <typename T>
Vec6Of<T> Displacement(const Eigen::Matrix<T, 7, 1>& from,
                       const Eigen::Matrix<T, 7, 1>& to) {
  Vec6Of<T> motion;
  motion << RotationLog<T>(QuaternionOf(to) * QuaternionOf(from).conjugate()),
      to.template tail<3>() - from.template tail<3>();
  return motion;
}

/// The matrix whose product with a vector is the cross product v × of it.
template <typename T>
Mat3Of<T> CrossMatrix(const Eigen::Matrix<T, 3, 1>& v) {
  Mat3Of<T> matrix;
  matrix << T(0), -v.z(), v.y(), v.z(), T(0), -v.x(), -v.y(), v.x(), T(0);
  return matrix;
}

}  // namespace drake_haptics
