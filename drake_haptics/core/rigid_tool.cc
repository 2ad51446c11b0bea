#include "rigid_tool.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace drake_haptics {
namespace {

Mat3 Cross(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

void RequirePhysical(const ToolInertia& inertia) {
  if (!std::isfinite(inertia.mass) || !(inertia.mass > 0)) {
    throw std::invalid_argument("mass must be finite and above 0 kg");
  }
  const Mat3& I = inertia.I_TTcm_T;
  if (!inertia.p_TTcm.allFinite() || !I.allFinite() ||
      !I.isApprox(I.transpose(), 1e-9) ||
      !(Eigen::SelfAdjointEigenSolver<Mat3>(I).eigenvalues().minCoeff() > 0)) {
    throw std::invalid_argument(
        "the rotational inertia must be symmetric and positive definite, the "
        "centre of mass finite");
  }
}

ToolMotionTerms ComputeMotionTerms(const ToolInertia& inertia,
                                   const ToolState& state) {
  const Mat3 R = QuaternionOf(state.q_WT).toRotationMatrix();
  const Vec3 c = R * inertia.p_TTcm;
  const Mat3 C = Cross(c);
  const double m = inertia.mass;
  const Mat3 I_To = R * inertia.I_TTcm_T * R.transpose() - m * C * C;
  const Vec3 w = state.V_WT.head<3>();

  ToolMotionTerms terms;
  terms.M << I_To, m * C, -m * C, m * Mat3::Identity();
  terms.b << w.cross(I_To * w), m * w.cross(w.cross(c));
  return terms;
}

ToolState StepTool(const ToolInertia& inertia, const ToolState& state,
                   const WrenchModel& wrench, double h) {
  const auto [M, b] = ComputeMotionTerms(inertia, state);
  const Mat6 left = M + h * wrench.B + h * h * wrench.K;
  const Vec6 right = h * (wrench.F - b - h * (wrench.K * state.V_WT));
  ToolState next;
  next.V_WT = state.V_WT + left.partialPivLu().solve(right);
  const Vec3 turn = h * next.V_WT.head<3>();
  const Eigen::Quaterniond R_next =
      (RotationExp(turn) * QuaternionOf(state.q_WT)).normalized();
  next.q_WT << R_next.w(), R_next.vec(),
      state.q_WT.tail<3>() + h * next.V_WT.tail<3>();
  return next;
}

}  // namespace drake_haptics
