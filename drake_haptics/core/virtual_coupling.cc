#include "virtual_coupling.h"

#include <Eigen/Geometry>

namespace drake_haptics {

CouplingStretch ComputeStretch(const PoseVector& q_WH, const PoseVector& q_HT,
                               const PoseVector& q_WT) {
  const Eigen::Quaterniond R_WH = QuaternionOf(q_WH);
  const Eigen::Quaterniond R_held = R_WH * QuaternionOf(q_HT);
  const Vec3 p_HT_W = R_WH * q_HT.tail<3>();
  return {p_HT_W, RotationLog(R_held * QuaternionOf(q_WT).conjugate()),
          q_WH.tail<3>() + p_HT_W - q_WT.tail<3>()};
}

CouplingWrench ComputeCoupling(const PoseVector& q_WH, const Vec6& V_WH,
                               const PoseVector& q_HT, const PoseVector& q_WT,
                               const Vec6& V_WT, const CouplingGains& gains) {
  const auto [p_HT_W, twist, stretch] = ComputeStretch(q_WH, q_HT, q_WT);
  const Vec3 w_WH = V_WH.head<3>();
  const Vec3 v_held = V_WH.tail<3>() + w_WH.cross(p_HT_W);
  const Vec3 force =
      gains.stiffness * stretch + gains.damping * (v_held - V_WT.tail<3>());
  const Vec3 torque = gains.rotational_stiffness * twist +
                      gains.rotational_damping * (w_WH - V_WT.head<3>());

  CouplingWrench result;
  result.tool.F << torque, force;
  result.tool.K.diagonal() << Vec3::Constant(gains.rotational_stiffness),
      Vec3::Constant(gains.stiffness);
  result.tool.B.diagonal() << Vec3::Constant(gains.rotational_damping),
      Vec3::Constant(gains.damping);
  result.F_display << -torque - p_HT_W.cross(force), -force;
  return result;
}

}  // namespace drake_haptics
