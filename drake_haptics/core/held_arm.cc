#include "held_arm.h"

#include <algorithm>
#include <cmath>

namespace drake_haptics {

MovingPose PosePath::Evaluate(double time) const {
  const double t = std::fmod(time, period);
  const auto next = std::upper_bound(starts.begin() + 1, starts.end(), t);
  const auto i = next - starts.begin() - 1;
  const double s = t - starts[i];
  const PoseVector value = cubics[i] * Eigen::Vector4d(1, s, s * s, s * s * s);
  const PoseVector rate = cubics[i] * Eigen::Vector4d(0, 1, 2 * s, 3 * s * s);

  const Eigen::Quaterniond R(value[0], value[1], value[2], value[3]);
  const Eigen::Quaterniond dR(rate[0], rate[1], rate[2], rate[3]);
  // The change of length is the real part of the product, which is not read.
  const Vec3 w = 2 * (dR * R.conjugate()).vec() / R.squaredNorm();
  MovingPose pose;
  pose.q << value.head<4>().normalized(), value.tail<3>();
  pose.V << w, rate.tail<3>();
  return pose;
}

SixJointArm::SixJointArm(const Mat6& J_WH, const PoseVector& q_WH)
    : R_WH_(QuaternionOf(q_WH)), p_WH_(q_WH.tail<3>()) {
  for (int i = 0; i < 6; ++i) {
    const Vec3 direction = J_WH.col(i).head<3>();
    // The point of the axis nearest to Ho: Ho is swept with v = w x (Ho -
    // point).
    const Vec3 v = J_WH.col(i).tail<3>();
    axes_[i] = {direction, p_WH_ + direction.cross(v)};
  }
}

SixJointArm::Handle SixJointArm::Evaluate(const State& state) const {
  // Motion from the zero pose of all that comes after the joint.
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  Vec3 p = Vec3::Zero();
  std::array<Axis, 6> axes;
  for (int i = 0; i < 6; ++i) {
    const Axis& axis = axes_[i];
    axes[i] = {R * axis.direction, R * axis.point + p};
    R = R * RotationExp<double>(state[i] * axis.direction);
    p = axes[i].point - R * axis.point;
  }
  const Eigen::Quaterniond R_WH = R * R_WH_;
  const Vec3 p_WH = R * p_WH_ + p;

  Handle handle;
  for (int i = 0; i < 6; ++i) {
    handle.J_WH.col(i) << axes[i].direction,
        axes[i].direction.cross(p_WH - axes[i].point);
  }
  handle.pose.q << R_WH.w(), R_WH.vec(), p_WH;
  handle.pose.V = handle.J_WH * state.tail<6>();
  return handle;
}

Vec6 HeldArm::JointTorques(double time, const SixJointArm::State& state,
                           const Vec6& F_applied) const {
  const SixJointArm::Handle handle = arm.Evaluate(state);
  const MovingPose aim = path.Evaluate(time);
  const Vec6 F_hand =
      ComputeCoupling(aim.q, aim.V, q_PH, handle.pose.q, handle.pose.V, gains)
          .tool.F;
  return handle.J_WH.transpose() * (F_applied + F_hand);
}

}  // namespace drake_haptics
