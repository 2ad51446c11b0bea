#pragma once

#include <limits>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// A one-sided spring on the motion ξ: where aᵀ ξ falls short of b by x, it
/// pushes along a with λ = min(k x, limit).
struct OneSidedSpring {
  Vec6 a = Vec6::Zero();                                   ///< [r × n; n]
  double b = 0;                                            ///< m
  double k = 0;                                            ///< N/m
  double limit = std::numeric_limits<double>::infinity();  ///< N

  /// Force λ at a motion, N.
  double Force(const Vec6& motion) const {
    const double force = k * (b - a.dot(motion));
    return force > 0 ? (force < limit ? force : limit) : 0;
  }
};

/// The problem that the motion ξ of a body in a tick solves, with a quadratic
/// and one-sided springs:
///
///   min_ξ  ½ ξᵀ H ξ − rᵀ ξ + Σ φ_i(b_i − a_iᵀ ξ),
///
/// where φ_i' = λ_i, so that φ_i is zero, then ½ k x², then linear. H is
/// positive definite: the minimum is unique.
struct ConstraintProblem {
  Mat6 H = Mat6::Identity();
  Vec6 r = Vec6::Zero();
  std::vector<OneSidedSpring> springs;
};

struct ConstraintSolution {
  Vec6 motion = Vec6::Zero();
  /// H + Σ k a aᵀ over the springs that push with less than their limit.
  Mat6 hessian = Mat6::Zero();
  int num_iterations = 0;
  bool is_bounded = false;  ///< the bound on iterations was reached
};

/// Buffers, kept between solutions so that a warm one allocates nothing.
struct ConstraintWorkspace {
  struct Kink {
    double place = 0;   ///< along the search direction, 1 at its end
    double change = 0;  ///< change of the second derivative
  };
  std::vector<Kink> kinks;
};

/// Bound on iterations, far above those that problems were seen to need.
inline constexpr int kMaxNewtonIterations = 64;

/// Solves the problem by Newton's method with an exact line search: the
/// function is piecewise quadratic and strictly convex, along a line its slope
/// is piecewise linear, and between its kinks each step is exact. So it ends
/// after finitely many steps, in most ticks one to three (Mangasarian, "A
/// finite Newton method for classification", 2002). Springs that are alike,
/// opposed or redundant need no special care.
/// @param start where the search begins.
ConstraintSolution SolveConstraintProblem(
    const ConstraintProblem& problem, const Vec6& start,
    ConstraintWorkspace* workspace, int max_iterations = kMaxNewtonIterations);

}  // namespace drake_haptics
