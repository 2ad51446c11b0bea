#include "tool/arm_dynamics.h"

#include <algorithm>
#include <cmath>

namespace drake_haptics {
namespace {

/// Time since the path last began, s.
double TimeOnPath(double time, double period) {
  return std::fmod(time, period);
}
AutoDiff TimeOnPath(const AutoDiff& time, double period) {
  return {std::fmod(time.value(), period), time.derivatives()};
}

}  // namespace

template <typename T>
MovingPoseOf<T> PosePath::Evaluate(const T& time) const {
  const T t = TimeOnPath(time, period);
  const auto next =
      std::upper_bound(starts.begin() + 1, starts.end(), ValueOf(t));
  const auto i = next - starts.begin() - 1;
  const T s = t - starts[i];
  const Eigen::Matrix<T, 7, 4> cubic = cubics[i].template cast<T>();
  const PoseVectorOf<T> value =
      cubic * Eigen::Vector4<T>(T(1), s, s * s, s * s * s);
  const PoseVectorOf<T> rate =
      cubic * Eigen::Vector4<T>(T(0), T(1), 2 * s, 3 * s * s);

  const Eigen::Quaternion<T> R(value[0], value[1], value[2], value[3]);
  const Eigen::Quaternion<T> dR(rate[0], rate[1], rate[2], rate[3]);
  // The real part of the product, the change of length, is not needed.
  const Vec3Of<T> w = 2 * (dR * R.conjugate()).vec() / R.squaredNorm();
  MovingPoseOf<T> pose;
  pose.q << value.template head<4>().normalized(), value.template tail<3>();
  pose.V << w, rate.template tail<3>();
  return pose;
}

SixJointArm::SixJointArm(const Mat6& J_WH, const PoseVector& q_WH)
    : R_WH_(QuaternionOf(q_WH)), p_WH_(q_WH.tail<3>()) {
  for (int i = 0; i < 6; ++i) {
    const Vec3 direction = J_WH.col(i).head<3>();
    // The point of the axis nearest to Ho, since v = w × (Ho − point).
    const Vec3 v = J_WH.col(i).tail<3>();
    axes_[i] = {direction, p_WH_ + direction.cross(v)};
  }
}

template <typename T>
SixJointArm::HandleOf<T> SixJointArm::Evaluate(
    const Eigen::Matrix<T, 12, 1>& state) const {
  // Motion of the links after the joint, from the zero pose.
  Eigen::Quaternion<T> R = Eigen::Quaternion<T>::Identity();
  Vec3Of<T> p = Vec3Of<T>::Zero();
  std::array<AxisOf<T>, 6> axes;
  for (int i = 0; i < 6; ++i) {
    const Vec3Of<T> direction = axes_[i].direction.template cast<T>();
    const Vec3Of<T> point = axes_[i].point.template cast<T>();
    axes[i] = {R * direction, R * point + p};
    R = R * RotationExp<T>(state[i] * direction);
    p = axes[i].point - R * point;
  }
  const Eigen::Quaternion<T> R_WH = R * R_WH_.template cast<T>();
  const Vec3Of<T> p_WH = R * p_WH_.template cast<T>() + p;

  HandleOf<T> handle;
  for (int i = 0; i < 6; ++i) {
    handle.J_WH.col(i) << axes[i].direction,
        axes[i].direction.cross(p_WH - axes[i].point);
  }
  handle.pose.q << R_WH.w(), R_WH.vec(), p_WH;
  handle.pose.V = handle.J_WH * state.template tail<6>();
  return handle;
}

template <typename T>
Vec6Of<T> ArmDynamics::JointTorques(
    const T& time, const Eigen::Matrix<T, 12, 1>& state,
    const Eigen::Matrix<T, 6, 1>& F_Ho_W_rendered) const {
  const SixJointArm::HandleOf<T> handle = arm.Evaluate(state);
  const MovingPoseOf<T> aim = path.Evaluate(time);
  const Vec6Of<T> F_hand =
      ComputeCoupling(aim.q, aim.V, q_PH, handle.pose.q, handle.pose.V, gains)
          .tool.F;
  return handle.J_WH.transpose() * (F_Ho_W_rendered + F_hand);
}

template MovingPose PosePath::Evaluate(const double&) const;
template SixJointArm::HandleOf<double> SixJointArm::Evaluate(
    const Eigen::Matrix<double, 12, 1>&) const;
template SixJointArm::HandleOf<AutoDiff> SixJointArm::Evaluate(
    const Eigen::Matrix<AutoDiff, 12, 1>&) const;
template Vec6 ArmDynamics::JointTorques(const double&,
                                        const Eigen::Matrix<double, 12, 1>&,
                                        const Vec6&) const;
template Vec6Of<AutoDiff> ArmDynamics::JointTorques(
    const AutoDiff&, const Eigen::Matrix<AutoDiff, 12, 1>&,
    const Vec6Of<AutoDiff>&) const;

}  // namespace drake_haptics
