#pragma once

#include <limits>

#include "base/rotation.h"
#include "base/types.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// Spring and damper of a six-degree-of-freedom coupling, and the most they
/// pull with.
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
  Vec6Of<T> F_Ho_W_commanded;  ///< its reaction on the handle at Ho, in W
};
using CouplingWrench = CouplingWrenchOf<double>;

/// Where the handle holds the tool, against where it is.
template <typename T>
struct CouplingStretchOf {
  Vec3Of<T> p_HT_W;   ///< from the handle to where it holds the tool, in W, m
  Vec3Of<T> twist;    ///< rotation vector from the tool to there, rad
  Vec3Of<T> stretch;  ///< from the tool to there, m

  /// [torque; force] of the spring, which yields: [k_r twist; k stretch], each
  /// shortened to its limit.
  Vec6Of<T> Load(const CouplingGains& gains) const;

  /// What the spring stores, J: ½ k |stretch|² + ½ k_r |twist|², and where it
  /// yields the work against its limit, f |stretch| − f²/(2 k).
  T Energy(const CouplingGains& gains) const;
};
using CouplingStretch = CouplingStretchOf<double>;

template <typename T>
CouplingStretchOf<T> ComputeStretch(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT);

/// Couples a tool to a handle: the tool is drawn to the pose X_WH·X_HT at
/// which the handle holds it, and the handle feels the reaction. The spring
/// acts between To and the point of the handle where To belongs, so that the
/// wrenches do the work which the spring's energy loses.
///
/// Spring and damper pull with no more than the gains' limits. The spring
/// yields where it would, s = P(k x) with P(v) = v min(1, f/|v|), and so does
/// the sum, P(s + b ẋ). A hand that is stronger than its device thus presses
/// the tool no harder than the device can show. P projects to a ball, so that
/// (P(s + b ẋ) − s)·ẋ >= 0: what is left of the damper only takes energy.
///
/// K and B are their slopes, for a small twist. Beyond the limit there is none
/// along the pull: (f/|v|)(I − v̂ v̂ᵀ) of it is left.
template <typename T>
CouplingWrenchOf<T> ComputeCoupling(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const Eigen::Matrix<T, 6, 1>& V_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT,
                                    const Eigen::Matrix<T, 6, 1>& V_WT,
                                    const CouplingGains& gains);

}  // namespace drake_haptics
