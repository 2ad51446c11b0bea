#pragma once

#include "base/rotation.h"
#include "base/types.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// Mass properties of the tool.
struct ToolInertia {
  double mass = 0;  ///< kg
  Vec3 p_TTcm;      ///< center of mass, in the tool's frame, m
  Mat3 I_TTcm_T;    ///< rotational inertia about Tcm, in T, kg·m²
};

/// Pose [qw qx qy qz x y z] and spatial velocity [rad/s; m/s] of the tool's
/// frame in the world.
template <typename T>
struct ToolStateOf {
  PoseVectorOf<T> q_WT;
  Vec6Of<T> V_WT;
};
using ToolState = ToolStateOf<double>;

/// The state as a vector [q_WT; V_WT].
template <typename T>
using ToolStateVectorOf = Eigen::Matrix<T, 13, 1>;
using ToolStateVector = ToolStateVectorOf<double>;

template <typename T>
ToolStateVectorOf<T> ToVector(const ToolStateOf<T>& state) {
  ToolStateVectorOf<T> vector;
  vector << state.q_WT, state.V_WT;
  return vector;
}
template <typename T>
ToolStateOf<T> ToToolState(const Eigen::Matrix<T, 13, 1>& vector) {
  return {vector.template head<7>(), vector.template tail<6>()};
}

/// @throws std::invalid_argument unless the mass is above zero and the inertia
///         is symmetric and positive definite.
void RequirePhysical(const ToolInertia& inertia);

/// Spatial inertia M about To in W and the velocity terms b of
/// M dV/dt + b = F.
template <typename T>
struct ToolMotionTermsOf {
  Mat6Of<T> M;
  Vec6Of<T> b;
};
using ToolMotionTerms = ToolMotionTermsOf<double>;

template <typename T>
ToolMotionTermsOf<T> ComputeMotionTerms(const ToolInertia& inertia,
                                        const ToolStateOf<T>& state);

/// Advances the free rigid tool by one step of linearized backward Euler:
///   (M + h B + h² K) ΔV = h (F − b − h K V),  V ← V + ΔV,  δ = h V,
/// where F, K, B are those of `wrench`.
/// It is stable for stiff contacts at any step; explicit steps limit the
/// stiffness to 4 m / h² (stability-and-device notes, section 5).
/// @param h step, s.
template <typename T>
ToolStateOf<T> StepTool(const ToolInertia& inertia, const ToolStateOf<T>& state,
                        const WrenchModelOf<T>& wrench, double h);

}  // namespace drake_haptics
