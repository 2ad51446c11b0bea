#include "constraint/constraint_problem.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace drake_haptics {
namespace {

// The search ends at a step that is no longer than this share of the motion and
// a millionth of an atom.
constexpr double kRelativeStep = 1e-12;
constexpr double kStep = 1e-16;  // m, and rad

// Returns the s in [0, 1] at which the function is least along
// start + s · step. Its slope rises along the line, with kinks where a spring
// begins to push or reaches its limit.
double LineMinimum(const ConstraintProblem& problem, const Vec6& start,
                   const Vec6& step, const Vec6& gradient,
                   ConstraintWorkspace* workspace) {
  double slope = gradient.dot(step);
  double bend = step.dot(problem.H * step);
  workspace->kinks.clear();
  for (std::size_t i = 0; i < problem.springs.size(); ++i) {
    const OneSidedSpring& spring = problem.springs[i];
    const double rise = spring.a.dot(step);
    if (rise == 0) continue;
    const double x = spring.b - spring.a.dot(start);
    const double full = spring.limit / spring.k;
    const double change = spring.k * rise * rise;
    // Along the line x falls if the step rises along a.
    const double first = rise > 0 ? full : 0.0;
    const double last = rise > 0 ? 0.0 : full;
    const double begin = (x - first) / rise, end = (x - last) / rise;
    if (begin <= 0 && end > 0) bend += change;
    if (begin > 0 && begin < 1) workspace->kinks.push_back({begin, change});
    if (end > 0 && end < 1) workspace->kinks.push_back({end, -change});
  }
  std::sort(workspace->kinks.begin(), workspace->kinks.end(),
            [](const auto& p, const auto& q) { return p.place < q.place; });
  double place = 0;
  for (const auto& kink : workspace->kinks) {
    const double next = slope + bend * (kink.place - place);
    if (next >= 0) break;
    slope = next;
    place = kink.place;
    bend += kink.change;
  }
  return std::min(1.0, place - slope / bend);
}

}  // namespace

ConstraintSolution SolveConstraintProblem(const ConstraintProblem& problem,
                                          const Vec6& start,
                                          ConstraintWorkspace* workspace,
                                          int max_iterations) {
  ConstraintSolution solution;
  solution.motion = start;
  for (;;) {
    Vec6 gradient = problem.H * solution.motion - problem.r;
    solution.hessian = problem.H;
    for (const OneSidedSpring& spring : problem.springs) {
      const double x = spring.b - spring.a.dot(solution.motion);
      if (!(x > 0)) continue;
      gradient -= std::min(spring.k * x, spring.limit) * spring.a;
      if (spring.k * x < spring.limit) {
        solution.hessian.noalias() +=
            spring.k * spring.a * spring.a.transpose();
      }
    }
    const Vec6 step = -solution.hessian.ldlt().solve(gradient);
    const double length = step.cwiseAbs().maxCoeff();
    if (!(length >
          kStep + kRelativeStep * solution.motion.cwiseAbs().maxCoeff())) {
      return solution;
    }
    if (solution.num_iterations == max_iterations) {
      solution.is_bounded = true;
      return solution;
    }
    ++solution.num_iterations;
    solution.motion +=
        LineMinimum(problem, solution.motion, step, gradient, workspace) * step;
  }
}

}  // namespace drake_haptics
