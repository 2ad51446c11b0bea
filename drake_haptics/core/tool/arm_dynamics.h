#pragma once

#include <array>
#include <vector>

#include "base/rotation.h"
#include "base/types.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

/// Pose [qw qx qy qz x y z] of a frame in the world and its spatial velocity
/// [rad/s; m/s] at its origin.
template <typename T>
struct MovingPoseOf {
  PoseVectorOf<T> q;
  Vec6Of<T> V;
};
using MovingPose = MovingPoseOf<double>;

/// A pose over time: in each segment, each entry of its vector is a cubic. The
/// quaternion need not have unit length; its direction is the rotation.
struct PosePath {
  /// Column i is the coefficient of (t − start)^i.
  using Cubic = Eigen::Matrix<double, 7, 4>;

  std::vector<double> starts;  ///< start of each segment, rising from 0, s
  std::vector<Cubic> cubics;   ///< one per segment; the last one never ends
  double period;               ///< time until it repeats, s, or infinity

  template <typename T>
  MovingPoseOf<T> Evaluate(const T& time) const;
};

/// Kinematics of a chain of six revolute joints from the world to a handle H,
/// as a product of exponentials (Murray, Li and Sastry 1994, sections 3.2
/// and 4.1).
class SixJointArm {
 public:
  template <typename T>
  struct HandleOf {
    MovingPoseOf<T> pose;
    Mat6Of<T> J_WH;  ///< spatial velocity of H per joint speed
  };

  /// @param J_WH spatial velocity of H per joint speed, with all angles zero.
  /// @param q_WH pose of H with all angles zero.
  SixJointArm(const Mat6& J_WH, const PoseVector& q_WH);

  /// @param state six joint angles, rad, then their speeds, rad/s.
  template <typename T>
  HandleOf<T> Evaluate(const Eigen::Matrix<T, 12, 1>& state) const;

 private:
  template <typename T>
  struct AxisOf {
    Vec3Of<T> direction;
    Vec3Of<T> point;
  };

  std::array<AxisOf<double>, 6> axes_;  ///< in the world, with all angles zero
  Eigen::Quaterniond R_WH_;
  Vec3 p_WH_;
};

/// A hand that pulls the handle of an arm to the pose X_WP(t) X_PH.
struct ArmDynamics {
  SixJointArm arm;
  PosePath path;
  PoseVector q_PH;
  CouplingGains gains;

  /// Joint torques (N·m) of the hand and of a wrench on the handle at Ho in W.
  template <typename T>
  Vec6Of<T> JointTorques(const T& time, const Eigen::Matrix<T, 12, 1>& state,
                         const Eigen::Matrix<T, 6, 1>& F_Ho_W_rendered) const;
};

}  // namespace drake_haptics
