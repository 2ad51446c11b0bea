#pragma once

#include <vector>

#include "base/autodiff.h"
#include "tool/rigid_tool.h"

namespace drake_haptics {

/// Inputs of a tick of a ConstraintStepper, with derivatives by D variables y.
///
/// At the motion ξ the gradient g(y, ξ) of a convex function is zero, so that
/// A dξ = −∂g/∂y dy with the Hessian A = H + Σ k a aᵀ (implicit function
/// theorem): one factorization serves all variables. The nearest features of
/// the pieces (row_gradient.h), the division of a fast tick and the set of rows
/// that push are fixed. At a kink the derivative is that of the pushing side: a
/// row that separates no faster than 1e-9 m/s pushes.
struct ConstraintTick {
  ToolStateOf<AutoDiff> state;
  PoseVectorOf<AutoDiff> q_WH;
  Vec6Of<AutoDiff> V_WH, F_applied;
  std::vector<PoseVectorOf<AutoDiff>> q_WO;  ///< pose of each object
  std::vector<Vec6Of<AutoDiff>> V_WO;
  Eigen::Index num_derivatives = 0;
};

/// Results of a tick, with derivatives.
struct ConstraintTickGradient {
  ToolStateOf<AutoDiff> next;            ///< tool's state at the tick's end
  Vec6Of<AutoDiff> F_To_W;               ///< of all rows on the tool at To
  std::vector<Vec6Of<AutoDiff>> F_Oo_W;  ///< on each object at its origin
};

}  // namespace drake_haptics
