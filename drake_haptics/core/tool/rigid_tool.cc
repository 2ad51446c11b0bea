#include "tool/rigid_tool.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace drake_haptics {
namespace {

template <typename T>
Mat3Of<T> CrossMatrix(const Vec3Of<T>& v) {
  Mat3Of<T> m;
  m << T(0), -v.z(), v.y(), v.z(), T(0), -v.x(), -v.y(), v.x(), T(0);
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
        "center of mass finite");
  }
}

template <typename T>
ToolMotionTermsOf<T> ComputeMotionTerms(const ToolInertia& inertia,
                                        const ToolStateOf<T>& state) {
  const Mat3Of<T> R = QuaternionOf(state.q_WT).toRotationMatrix();
  const Vec3Of<T> c = R * inertia.p_TTcm.template cast<T>();
  const Mat3Of<T> C = CrossMatrix(c);
  const double m = inertia.mass;
  const Mat3Of<T> I_To =
      R * inertia.I_TTcm_T.template cast<T>() * R.transpose() - m * C * C;
  const Vec3Of<T> w = state.V_WT.template head<3>();

  ToolMotionTermsOf<T> terms;
  terms.M << I_To, m * C, -m * C, m * Mat3Of<T>::Identity();
  terms.b << w.cross(I_To * w), m * w.cross(w.cross(c));
  return terms;
}

template <typename T>
ToolStateOf<T> StepTool(const ToolInertia& inertia, const ToolStateOf<T>& state,
                        const WrenchModelOf<T>& wrench, double h) {
  const auto [M, b] = ComputeMotionTerms(inertia, state);
  const Mat6Of<T> left = M + h * wrench.B + h * h * wrench.K;
  const Vec6Of<T> right = h * (wrench.F - b - h * (wrench.K * state.V_WT));
  ToolStateOf<T> next;
  next.V_WT = state.V_WT + left.partialPivLu().solve(right);
  next.q_WT = Displaced<T>(state.q_WT, h * next.V_WT);
  return next;
}

template ToolMotionTermsOf<double> ComputeMotionTerms(const ToolInertia&,
                                                      const ToolState&);
template ToolMotionTermsOf<AutoDiff> ComputeMotionTerms(
    const ToolInertia&, const ToolStateOf<AutoDiff>&);
template ToolState StepTool(const ToolInertia&, const ToolState&,
                            const WrenchModel&, double);
template ToolStateOf<AutoDiff> StepTool(const ToolInertia&,
                                        const ToolStateOf<AutoDiff>&,
                                        const WrenchModelOf<AutoDiff>&, double);

}  // namespace drake_haptics
