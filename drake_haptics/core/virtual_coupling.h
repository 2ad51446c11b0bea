#pragma once

#include "rotation.h"
#include "types.h"
#include "wrench_model.h"

namespace drake_haptics {

/// Spring and damper of a six-degree-of-freedom coupling.
struct CouplingGains {
  double stiffness = 0;             ///< N/m
  double damping = 0;               ///< N·s/m
  double rotational_stiffness = 0;  ///< N·m/rad
  double rotational_damping = 0;    ///< N·m·s/rad
};

template <typename T>
struct CouplingWrenchOf {
  WrenchModelOf<T> tool;  ///< on the tool at To
  Vec6Of<T> F_display;    ///< its reaction on the handle at Ho, in W
};
using CouplingWrench = CouplingWrenchOf<double>;

/// Where the handle holds the tool, against where it is.
template <typename T>
struct CouplingStretchOf {
  Vec3Of<T> p_HT_W;   ///< from the handle to where it holds the tool, in W, m
  Vec3Of<T> twist;    ///< rotation vector from the tool to there, rad
  Vec3Of<T> stretch;  ///< from the tool to there, m

  /// ½ k |stretch|² + ½ k_r |twist|², J.
  T Energy(const CouplingGains& gains) const {
    return 0.5 * (gains.stiffness * stretch.squaredNorm() +
                  gains.rotational_stiffness * twist.squaredNorm());
  }
};
using CouplingStretch = CouplingStretchOf<double>;

template <typename T>
CouplingStretchOf<T> ComputeStretch(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT);

/// Couples a tool to a handle: the tool is drawn to the pose X_WH·X_HT at
/// which the handle holds it, and the handle feels the reaction. The spring
/// acts between To and the point of the handle where To belongs, so that the
/// wrenches do the work which the spring's energy loses. K is that of the
/// relaxed spring.
template <typename T>
CouplingWrenchOf<T> ComputeCoupling(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const Eigen::Matrix<T, 6, 1>& V_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT,
                                    const Eigen::Matrix<T, 6, 1>& V_WT,
                                    const CouplingGains& gains);

}  // namespace drake_haptics
