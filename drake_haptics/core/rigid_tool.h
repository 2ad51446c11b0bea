#pragma once

#include "rotation.h"
#include "types.h"
#include "wrench_model.h"

namespace drake_haptics {

/// Mass properties of the tool.
struct ToolInertia {
  double mass = 0;  ///< kg
  Vec3 p_TTcm;      ///< centre of mass, in the tool's frame, m
  Mat3 I_TTcm_T;    ///< rotational inertia about it, in T, kg·m²
};

/// Pose [qw qx qy qz x y z] and spatial velocity [rad/s; m/s] of the tool's
/// frame in the world.
struct ToolState {
  PoseVector q_WT;
  Vec6 V_WT;
};

/// @throws std::invalid_argument unless the mass is above zero and the inertia
///         is symmetric and positive definite.
void RequirePhysical(const ToolInertia& inertia);

/// Spatial inertia M about To in W and the velocity terms b of
/// M dV/dt + b = F.
struct ToolMotionTerms {
  Mat6 M;
  Vec6 b;
};

ToolMotionTerms ComputeMotionTerms(const ToolInertia& inertia,
                                   const ToolState& state);

/// Advances the free rigid tool by one step of linearized backward Euler:
///   (M + h B + h² K) ΔV = h (F − b − h K V),  V ← V + ΔV,  δ = h V,
/// where F, K, B are those of `wrench`.
/// Stable for stiff contacts at any step, where explicit steps are bounded by
/// 4 m / h² (stability-and-device notes, section 5).
/// @param h step, s.
ToolState StepTool(const ToolInertia& inertia, const ToolState& state,
                   const WrenchModel& wrench, double h);

}  // namespace drake_haptics
