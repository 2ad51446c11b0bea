#pragma once

#include <vector>

#include "base/autodiff.h"
#include "tool/rigid_tool.h"

namespace drake_haptics {

/// What a tick of a ConstraintStepper is a function of, with derivatives by D
/// variables y.
///
/// The motion ξ is where the gradient g(y, ξ) of a convex function is zero, so
/// that A dξ = −∂g/∂y dy with the Hessian A = H + Σ k a aᵀ (implicit function
/// theorem): one factor serves all variables. What stays is which features the
/// pieces have next to each other (row_gradient.h), how a fast tick is divided,
/// and which rows push. At a kink it is the side on which they do: a row that
/// parts no faster than 1e-9 m/s pushes.
struct ConstraintTick {
  ToolStateOf<AutoDiff> state;
  PoseVectorOf<AutoDiff> q_WH;
  Vec6Of<AutoDiff> V_WH, F_applied;
  std::vector<PoseVectorOf<AutoDiff>> q_WO;  ///< of each object
  std::vector<Vec6Of<AutoDiff>> V_WO;
  Eigen::Index num_derivatives = 0;
};

/// What comes of it.
struct ConstraintTickGradient {
  ToolStateOf<AutoDiff> next;            ///< of the tool, at the tick's end
  Vec6Of<AutoDiff> F_To_W;               ///< of all rows on the tool at To
  std::vector<Vec6Of<AutoDiff>> F_Oo_W;  ///< on each object at its origin
};

}  // namespace drake_haptics
