#pragma once

#include <array>
#include <vector>

#include "rotation.h"
#include "types.h"
#include "virtual_coupling.h"

namespace drake_haptics {

/// Pose [qw qx qy qz x y z] of a frame in the world and its spatial velocity
/// [rad/s; m/s] at its origin.
struct MovingPose {
  PoseVector q;
  Vec6 V;
};

/// A pose over time: each entry of its vector a cubic in each segment. The
/// quaternion need not be of unit length; its direction is the rotation.
struct PosePath {
  /// Column i is the coefficient of (t − start)^i.
  using Cubic = Eigen::Matrix<double, 7, 4>;

  std::vector<double> starts;  ///< of the segments, rising from 0, s
  std::vector<Cubic> cubics;   ///< one per segment; the last one never ends
  double period;               ///< when it begins anew, s; infinite if never

  MovingPose Evaluate(double time) const;
};

/// Kinematics of a chain of six revolute joints from the world to a handle H,
/// as a product of exponentials (Murray, Li and Sastry 1994, sections 3.2
/// and 4.1).
class SixJointArm {
 public:
  /// Six joint angles, rad, then their speeds, rad/s.
  using State = Eigen::Matrix<double, 12, 1>;

  struct Handle {
    MovingPose pose;
    Mat6 J_WH;  ///< spatial velocity of H per joint speed
  };

  /// @param J_WH as in Handle, with all angles zero.
  /// @param q_WH pose of H there.
  SixJointArm(const Mat6& J_WH, const PoseVector& q_WH);

  Handle Evaluate(const State& state) const;

 private:
  struct Axis {
    Vec3 direction;
    Vec3 point;
  };

  std::array<Axis, 6> axes_;  ///< in the world, with all angles zero
  Eigen::Quaterniond R_WH_;
  Vec3 p_WH_;
};

/// A hand that draws the handle of an arm to X_WP(t) X_PH.
struct HeldArm {
  SixJointArm arm;
  PosePath path;
  PoseVector q_PH;
  CouplingGains gains;

  /// Joint torques (N·m) of the hand and of a wrench on the handle at Ho in W.
  Vec6 JointTorques(double time, const SixJointArm::State& state,
                    const Vec6& F_applied) const;
};

}  // namespace drake_haptics
