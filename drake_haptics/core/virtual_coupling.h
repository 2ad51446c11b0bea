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

struct CouplingWrench {
  WrenchModel tool;               ///< on the tool at To
  Vec6 F_display = Vec6::Zero();  ///< its reaction on the handle at Ho, in W
};

/// Where the handle holds the tool, against where it is.
struct CouplingStretch {
  Vec3 p_HT_W;   ///< from the handle to where it holds the tool, in W, m
  Vec3 twist;    ///< rotation vector from the tool to there, rad
  Vec3 stretch;  ///< from the tool to there, m

  /// ½ k |stretch|² + ½ k_r |twist|², J.
  double Energy(const CouplingGains& gains) const {
    return 0.5 * (gains.stiffness * stretch.squaredNorm() +
                  gains.rotational_stiffness * twist.squaredNorm());
  }
};

CouplingStretch ComputeStretch(const PoseVector& q_WH, const PoseVector& q_HT,
                               const PoseVector& q_WT);

/// Couples a tool to a handle: the tool is drawn to the pose X_WH·X_HT at
/// which the handle holds it, and the handle feels the reaction. The spring
/// acts between To and the point of the handle where To belongs, so that the
/// wrenches do the work which the spring's energy loses. K is that of the
/// relaxed spring.
CouplingWrench ComputeCoupling(const PoseVector& q_WH, const Vec6& V_WH,
                               const PoseVector& q_HT, const PoseVector& q_WT,
                               const Vec6& V_WT, const CouplingGains& gains);

}  // namespace drake_haptics
