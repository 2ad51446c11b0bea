/// Derivatives of what turns, with Eigen's checks that their lengths agree.

#include "base/autodiff.h"

#include <Eigen/Dense>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>

#include "base/rotation.h"
#include "check.h"
#include "law/penalty_force.h"
#include "tool/arm_dynamics.h"
#include "tool/rigid_tool.h"

namespace drake_haptics {
namespace {

const Vec3 kAxis(0.36, 0.48, -0.8);

template <int Size>
AutoDiffVector Variables(const Eigen::Matrix<double, Size, 1>& values) {
  return {values, Eigen::MatrixXd::Identity(Size, Size)};
}

Eigen::Vector4d ExpCoeffs(const Vec3& r) {
  return RotationExp<double>(r).coeffs();
}

/// By central differences of sixth order.
Eigen::Matrix<double, 4, 3> ExpSlope(const Vec3& r, double h) {
  Eigen::Matrix<double, 4, 3> slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 d = h * Vec3::Unit(i);
    slope.col(i) = (45 * (ExpCoeffs(r + d) - ExpCoeffs(r - d)) -
                    9 * (ExpCoeffs(r + 2 * d) - ExpCoeffs(r - 2 * d)) +
                    (ExpCoeffs(r + 3 * d) - ExpCoeffs(r - 3 * d))) /
                   (60 * h);
  }
  return slope;
}

/// On both sides of the angle below which the series is used, and up to half a
/// turn, where the logarithm ends.
void RotationsHaveTheirSlope() {
  for (const double angle :
       {0.0, 1e-12, 1e-7, 1.9e-6, 2.1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.0,
        M_PI - 1e-3, M_PI - 1e-6, M_PI - 1e-9}) {
    const Vec3 r = angle * kAxis;
    const Vec3Of<AutoDiff> variables = ToScalars<3>(Variables<3>(r), "r");
    const Eigen::Quaternion<AutoDiff> q = RotationExp<AutoDiff>(variables);
    const AutoDiffVector exp = ToAutoDiffVector(q.coeffs(), 3);
    CHECK(exp.value.isApprox(ExpCoeffs(r), 1e-15));
    CHECK((exp.gradient - ExpSlope(r, 1e-3)).cwiseAbs().maxCoeff() < 1e-11);

    // The logarithm undoes it, also of the other quaternion of the rotation.
    const Eigen::Quaternion<AutoDiff> other(-q.w(), -q.x(), -q.y(), -q.z());
    for (const auto& rotation : {q, other}) {
      const AutoDiffVector log =
          ToAutoDiffVector(RotationLog<AutoDiff>(rotation), 3);
      CHECK((log.value - r).norm() < 1e-13);
      CHECK((log.gradient - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-8);
    }
  }
}

/// Half a turn itself is a kink: a derivative from one side, and no NaN.
void HalfATurnHasFiniteSlope() {
  const Vec3 r = M_PI * kAxis;
  const Eigen::Quaternion<AutoDiff> q =
      RotationExp<AutoDiff>(ToScalars<3>(Variables<3>(r), "r"));
  CHECK(ToAutoDiffVector(RotationLog<AutoDiff>(q), 3).gradient.allFinite());
}

ArmDynamics MakeArm(double period) {
  Mat6 J_WH;
  for (int i = 0; i < 6; ++i) {
    const Vec3 direction = Vec3(1 + i, i * i - 3, 2 - i).normalized();
    const Vec3 point(0.1 * i, 0.05, -0.02 * i);
    J_WH.col(i) << direction, direction.cross(Vec3(0.3, 0.2, 0.1) - point);
  }
  PoseVector q_WH, q_PH;
  q_WH << 0.6, 0.8, 0, 0, 0.3, 0.2, 0.1;
  q_PH << 1, 0, 0, 0, 0.01, 0, 0;
  PosePath::Cubic cubic = PosePath::Cubic::Zero();
  cubic.col(0) = q_WH;
  cubic.col(1) << 0.1, 0.2, 0.3, 0.4, 0.01, 0.02, 0.03;
  cubic.col(3) = 0.5 * cubic.col(1);
  return {SixJointArm(J_WH, q_WH),
          PosePath{{0.0, 0.5}, {cubic, cubic}, period},
          q_PH,
          {300, 5, 1, 0.02}};
}

/// By time, state and wrench at once; then by time alone, all else constant.
void ArmsHaveTheirSlope() {
  const ArmDynamics arm = MakeArm(0.7);
  Eigen::Matrix<double, 19, 1> x;
  x << 1.3, 0.1, -0.2, 0.3, 0.4, -0.5, 0.6, 1, 2, 3, -1, -2, -3, 0.1, 0.2, 0.3,
      1, 2, 3;
  const auto torques = [&](const auto& z) {
    using T = typename std::decay_t<decltype(z)>::Scalar;
    return arm.JointTorques<T>(z[0], z.template segment<12>(1),
                               z.template tail<6>());
  };
  const AutoDiffVector found =
      ToAutoDiffVector(torques(ToScalars<19>(Variables<19>(x), "x")), x.size());
  CHECK(found.value.isApprox(torques(x), 1e-14));
  const double h = 1e-5;
  for (int i = 0; i < x.size(); ++i) {
    const Eigen::Matrix<double, 19, 1> d =
        h * Eigen::Matrix<double, 19, 1>::Unit(i);
    const Vec6 slope = (torques(x + d) - torques(x - d)) / (2 * h);
    CHECK((found.gradient.col(i) - slope).norm() < 1e-6 * (1 + slope.norm()));
  }

  Eigen::Matrix<AutoDiff, 19, 1> by_time = x.cast<AutoDiff>();
  by_time[0].derivatives() = Eigen::VectorXd::Ones(1);
  CHECK(ToAutoDiffVector(torques(by_time), 1)
            .gradient.isApprox(found.gradient.col(0), 1e-12));
}

/// A tool that starts where all is constant, pushed by what is not.
void ConstantsMix() {
  ToolStateOf<AutoDiff> state;
  state.q_WT << AutoDiff(1), AutoDiff(0), AutoDiff(0), AutoDiff(0), AutoDiff(0),
      AutoDiff(0), AutoDiff(0);
  state.V_WT = Vec6::Zero().cast<AutoDiff>();
  WrenchModelOf<AutoDiff> wrench;
  wrench.F = ToScalars<6>(Variables<6>(Vec6::Constant(0.1)), "F");
  wrench.K = (100 * Mat6::Identity()).cast<AutoDiff>();
  wrench.B = Mat6::Identity().cast<AutoDiff>();
  const ToolInertia inertia{0.1, Vec3(0.01, 0, 0), 1e-4 * Mat3::Identity()};
  const AutoDiffVector V = ToAutoDiffVector(
      StepTool<AutoDiff>(inertia, state, wrench, 1e-3).V_WT, 6);
  // One linear equation: dV/dF F = V.
  CHECK((V.gradient * Vec6::Constant(0.1)).isApprox(V.value, 1e-12));
}

/// A cluster that others relieve wholly, beside one that pushes.
void WhatPushesNothingMixes() {
  const auto variables = ToScalars<6>(Variables<6>(Vec6::Constant(-0.1)), "V");
  ClusterOf<AutoDiff> cluster;
  cluster.distance = variables[0];
  cluster.nhat_BA_W =
      Vec3Of<AutoDiff>(variables[0], variables[1], variables[2]);
  cluster.p_WC = cluster.nhat_BA_W;
  ClusterSetOf<AutoDiff> set;
  set.clusters = {cluster, cluster};
  set.clusters[1].compression = variables[3];
  set.clusters[1].damping_share = variables[4];
  set.coupling.members = {{0, 2, 0}, {0, 2, 2}};
  set.coupling.together = {AutoDiff(0), AutoDiff(0), AutoDiff(0), variables[5]};
  MovingFrameOf<AutoDiff> tool, object;
  tool.V_WF = -variables;
  object.V_WF = variables;
  const auto wrench =
      ComputePenaltyWrench<AutoDiff>(set, tool, {object}, {{100.0, 2.0}});
  const AutoDiffVector F = ToAutoDiffVector(wrench.tool.F, 6);
  CHECK(F.value.norm() > 0 && F.gradient.norm() > 0);
  CHECK(ToAutoDiffVector(wrench.tool.K.col(5), 6).gradient.norm() > 0);
}

void LengthsMustAgree() {
  const AutoDiffVector two = Variables<2>({1, 2});
  const AutoDiffVector three = Variables<3>({1, 2, 3});
  CHECK(CommonNumDerivatives(two) == 2);
  CHECK(CommonNumDerivatives(three, three) == 3);
  CHECK_THROWS(CommonNumDerivatives(three, three, two), std::invalid_argument);
  CHECK_THROWS(ToScalars<3>(two, "two"), std::invalid_argument);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::RotationsHaveTheirSlope();
  drake_haptics::HalfATurnHasFiniteSlope();
  drake_haptics::ArmsHaveTheirSlope();
  drake_haptics::ConstantsMix();
  drake_haptics::WhatPushesNothingMixes();
  drake_haptics::LengthsMustAgree();
  return drake_haptics::FailedChecks() > 0;
}
