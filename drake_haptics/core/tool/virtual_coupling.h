#pragma once

#include <limits>

#include "base/rotation.h"
#include "base/types.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// Gains of a six-degree-of-freedom coupling's spring and damper, and the
/// limits of their total force and torque.
struct CouplingGains {
  double stiffness = 0;                                         ///< N/m
  double damping = 0;                                           ///< N·s/m
  double rotational_stiffness = 0;                              ///< N·m/rad
  double rotational_damping = 0;                                ///< N·m·s/rad
  double max_force = std::numeric_limits<double>::infinity();   ///< N
  double max_torque = std::numeric_limits<double>::infinity();  ///< N·m
};

template <typename T>
struct CouplingWrenchOf {
  WrenchModelOf<T> tool;       ///< on the tool at To
  Vec6Of<T> F_Ho_W_commanded;  ///< reaction on the handle at Ho, in W
};
using CouplingWrench = CouplingWrenchOf<double>;

/// Displacement from the tool to the pose at which the handle holds it.
template <typename T>
struct CouplingStretchOf {
  Vec3Of<T> p_HT_W;   ///< from the handle to the held pose, in W, m
  Vec3Of<T> twist;    ///< rotation vector from tool to held pose, rad
  Vec3Of<T> stretch;  ///< from the tool to the held pose, m

  /// [torque; force] of the yielding spring: [k_r twist; k stretch], each
  /// shortened to its limit.
  Vec6Of<T> Load(const CouplingGains& gains) const;

  /// Energy of the spring, J: ½ k |stretch|² + ½ k_r |twist|², and where it
  /// yields f |stretch| − f²/(2 k), the work against its limit f.
  T Energy(const CouplingGains& gains) const;
};
using CouplingStretch = CouplingStretchOf<double>;

template <typename T>
CouplingStretchOf<T> ComputeStretch(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT);

/// Couples a tool to a handle: the tool is pulled to the pose X_WH·X_HT at
/// which the handle holds it, and the handle feels the reaction. The spring
/// acts between To and its point in the handle, so that both wrenches together
/// do the work that the spring's energy loses.
///
/// Spring and damper pull with no more than the gains' limits. The spring
/// yields at its limit, s = P(k x) with P(v) = v min(1, f/|v|), and the sum is
/// limited as well, P(s + b ẋ). A hand that is stronger than its device thus
/// presses the tool no harder than the device can show. P projects to a ball,
/// so that (P(s + b ẋ) − s)·ẋ >= 0: the limited damper only takes energy.
///
/// K and B are the slopes of the pull for a small twist. Beyond the limit they
/// are multiplied by (f/|v|)(I − v̂ v̂ᵀ), which is zero along the pull.
template <typename T>
CouplingWrenchOf<T> ComputeCoupling(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const Eigen::Matrix<T, 6, 1>& V_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT,
                                    const Eigen::Matrix<T, 6, 1>& V_WT,
                                    const CouplingGains& gains);

}  // namespace drake_haptics
