#include "virtual_coupling.h"

#include <Eigen/Geometry>

namespace drake_haptics {

template <typename T>
CouplingStretchOf<T> ComputeStretch(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT) {
  const Eigen::Quaternion<T> R_WH = QuaternionOf(q_WH);
  const Eigen::Quaternion<T> R_held =
      R_WH * QuaternionOf(q_HT).template cast<T>();
  const Vec3Of<T> p_HT_W = R_WH * q_HT.tail<3>().template cast<T>();
  return {p_HT_W, RotationLog<T>(R_held * QuaternionOf(q_WT).conjugate()),
          q_WH.template tail<3>() + p_HT_W - q_WT.template tail<3>()};
}

template <typename T>
CouplingWrenchOf<T> ComputeCoupling(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const Eigen::Matrix<T, 6, 1>& V_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT,
                                    const Eigen::Matrix<T, 6, 1>& V_WT,
                                    const CouplingGains& gains) {
  const auto [p_HT_W, twist, stretch] = ComputeStretch<T>(q_WH, q_HT, q_WT);
  const Vec3Of<T> w_WH = V_WH.template head<3>();
  const Vec3Of<T> v_held = V_WH.template tail<3>() + w_WH.cross(p_HT_W);
  const Vec3Of<T> force = gains.stiffness * stretch +
                          gains.damping * (v_held - V_WT.template tail<3>());
  const Vec3Of<T> torque =
      gains.rotational_stiffness * twist +
      gains.rotational_damping * (w_WH - V_WT.template head<3>());

  CouplingWrenchOf<T> result;
  result.tool.F << torque, force;
  result.tool.K.diagonal() << Vec3Of<T>::Constant(gains.rotational_stiffness),
      Vec3Of<T>::Constant(gains.stiffness);
  result.tool.B.diagonal() << Vec3Of<T>::Constant(gains.rotational_damping),
      Vec3Of<T>::Constant(gains.damping);
  result.F_display << -torque - p_HT_W.cross(force), -force;
  return result;
}

template CouplingStretchOf<double> ComputeStretch(const PoseVector&,
                                                  const PoseVector&,
                                                  const PoseVector&);
template CouplingWrenchOf<double> ComputeCoupling(
    const PoseVector&, const Vec6&, const PoseVector&, const PoseVector&,
    const Vec6&, const CouplingGains&);
template CouplingWrenchOf<AutoDiff> ComputeCoupling(
    const PoseVectorOf<AutoDiff>&, const Vec6Of<AutoDiff>&, const PoseVector&,
    const PoseVectorOf<AutoDiff>&, const Vec6Of<AutoDiff>&,
    const CouplingGains&);

}  // namespace drake_haptics
