#include "tool/rigid_tool.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drake_haptics {
namespace {

// The solution of A x = b.
Vec6 Solve(const Mat6& A, const Vec6& b) { return A.partialPivLu().solve(b); }

// The same with derivatives, by A dx = db − dA x.
Vec6Of<AutoDiff> Solve(const Mat6Of<AutoDiff>& A, const Vec6Of<AutoDiff>& b) {
  const Eigen::PartialPivLU<Mat6> factors(ValuesOf(A));
  const Vec6 x = factors.solve(ValuesOf(b));
  const Vec6Of<AutoDiff> rest = b - A * x;
  Eigen::Index num_derivatives = 0;
  for (const AutoDiff& entry : rest) {
    num_derivatives = std::max(num_derivatives, entry.derivatives().size());
  }
  AutoDiffVector moving = ToAutoDiffVector(rest, num_derivatives);
  moving.value = x;
  for (auto column : moving.gradient.colwise()) {
    column = factors.solve(Vec6(column));
  }
  return ToScalars<6>(moving, "x");
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
  next.V_WT = state.V_WT + Solve(left, right);
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
