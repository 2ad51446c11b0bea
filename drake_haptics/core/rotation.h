#pragma once

#include <Eigen/Geometry>

#include "types.h"

namespace drake_haptics {

/// Rotation by the vector r (rad): exp of its cross-product matrix.
Eigen::Quaterniond RotationExp(const Vec3& r);

/// The rotation vector (rad) of q, of length at most π. Inverse of
/// RotationExp.
Vec3 RotationLog(const Eigen::Quaterniond& q);

/// A pose as Drake's vector [qw qx qy qz x y z].
using PoseVector = Eigen::Matrix<double, 7, 1>;

/// @throws std::invalid_argument unless all values are finite and the
///         quaternion can be normalised. `what` names the pose in the message.
Pose PoseFromVector(const PoseVector& q, const char* what);

/// The quaternion of a pose vector, normalised.
inline Eigen::Quaterniond QuaternionOf(const PoseVector& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

}  // namespace drake_haptics
