// Newton's method against all cases of springs that rest, push or are at their
// limit, one by one.
#include "constraint/constraint_problem.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "check.h"

namespace drake_haptics {
namespace {

std::mt19937 generator(0);

double Normal() {
  static std::normal_distribution<double> normal;
  return normal(generator);
}

Vec6 RandomVector() {
  return Vec6::NullaryExpr([] { return Normal(); });
}

// Springs of all kinds: soft and hard, with and without a limit, some alike,
// some opposed.
ConstraintProblem RandomProblem(int num_springs) {
  ConstraintProblem problem;
  const Mat6 root = Mat6::NullaryExpr([] { return Normal(); });
  problem.H = root * root.transpose() + 0.1 * Mat6::Identity();
  problem.r = 3 * RandomVector();
  for (int i = 0; i < num_springs; ++i) {
    OneSidedSpring spring;
    spring.a = RandomVector();
    if (i > 0 && Normal() > 0.5) spring.a = problem.springs[0].a;
    if (i > 0 && Normal() > 0.8) spring.a = -problem.springs[0].a;
    spring.b = Normal();
    spring.k = std::pow(10, 2 + Normal());
    if (Normal() > 0) spring.limit = std::abs(Normal());
    problem.springs.push_back(spring);
  }
  return problem;
}

// The one case whose linear equations have an answer that belongs to it.
std::optional<Vec6> FindByCases(const ConstraintProblem& problem) {
  enum Case { kRests, kPushes, kAtLimit, kNumCases };
  const std::size_t count = problem.springs.size();
  std::vector<int> cases(count, kRests);
  for (;;) {
    Mat6 H = problem.H;
    Vec6 r = problem.r;
    bool has_limit = true;
    for (std::size_t i = 0; i < count; ++i) {
      const OneSidedSpring& spring = problem.springs[i];
      if (cases[i] == kPushes) {
        H += spring.k * spring.a * spring.a.transpose();
        r += spring.k * spring.b * spring.a;
      } else if (cases[i] == kAtLimit) {
        has_limit = has_limit && std::isfinite(spring.limit);
        if (has_limit) r += spring.limit * spring.a;
      }
    }
    const Vec6 motion = H.ldlt().solve(r);
    const auto is_so = [&](std::size_t i) {
      const OneSidedSpring& spring = problem.springs[i];
      const double force = spring.k * (spring.b - spring.a.dot(motion));
      if (cases[i] == kRests) return force <= 1e-9;
      if (cases[i] == kAtLimit) return force >= spring.limit - 1e-9;
      return force >= -1e-9 && force <= spring.limit + 1e-9;
    };
    bool is_all = has_limit;
    for (std::size_t i = 0; i < count && is_all; ++i) is_all = is_so(i);
    if (is_all) return motion;
    std::size_t next = 0;
    while (next < count && ++cases[next] == kNumCases) cases[next++] = kRests;
    if (next == count) return std::nullopt;
  }
}

void ItIsTheOneCaseThatFits() {
  ConstraintWorkspace workspace;
  int num_pushing = 0;
  for (int k = 0; k < 100; ++k) {
    const ConstraintProblem problem = RandomProblem(1 + k % 5);
    const auto expected = FindByCases(problem);
    CHECK(expected.has_value());
    if (!expected) continue;
    const ConstraintSolution solution =
        SolveConstraintProblem(problem, RandomVector(), &workspace);
    CHECK(!solution.is_bounded);
    CHECK((solution.motion - *expected).norm() < 1e-8);
    for (const OneSidedSpring& spring : problem.springs) {
      num_pushing += spring.Force(solution.motion) > 0;
    }
  }
  CHECK(num_pushing > 50);
}

// As hard as rows are, and many: the gradient tells.
void ManyHardSpringsAreSolved() {
  ConstraintWorkspace workspace;
  int most = 0;
  for (int k = 0; k < 200; ++k) {
    ConstraintProblem problem;
    problem.H.diagonal() << 10, 10, 10, 5e4, 5e4, 5e4;
    problem.r = 5e4 * 1e-3 * RandomVector();
    problem.r.head<3>() *= 1e-2;
    for (int i = 0; i < 1 + k; ++i) {
      const Vec3 n = RandomVector().head<3>().normalized();
      OneSidedSpring spring;
      spring.a << (0.02 * RandomVector().head<3>()).cross(n), n;
      spring.b = -1e-3 * std::abs(Normal());
      spring.k = 1e9;
      problem.springs.push_back(spring);
    }
    const ConstraintSolution solution =
        SolveConstraintProblem(problem, Vec6::Zero(), &workspace);
    CHECK(!solution.is_bounded);
    most = std::max(most, solution.num_iterations);
    Vec6 gradient = problem.H * solution.motion - problem.r;
    for (const OneSidedSpring& spring : problem.springs) {
      const double force = spring.Force(solution.motion);
      CHECK(force < 1e3);
      gradient -= force * spring.a;
    }
    CHECK(gradient.norm() < 1e-5);
  }
  CHECK(most > 1 && most < kMaxNewtonIterations / 2);
}

// (P3): what says what another one says changes nothing.
void ADuplicateOfAHardSpringChangesNothing() {
  ConstraintWorkspace workspace;
  for (int k = 0; k < 100; ++k) {
    ConstraintProblem problem = RandomProblem(4);
    for (OneSidedSpring& spring : problem.springs) {
      spring.k = 1e9;
      spring.limit = std::numeric_limits<double>::infinity();
      spring.b = -std::abs(spring.b);
    }
    const Vec6 once =
        SolveConstraintProblem(problem, Vec6::Zero(), &workspace).motion;
    const auto springs = problem.springs;
    for (int copy = 0; copy < 9; ++copy) {
      problem.springs.insert(problem.springs.end(), springs.begin(),
                             springs.end());
    }
    const Vec6 tenfold =
        SolveConstraintProblem(problem, Vec6::Zero(), &workspace).motion;
    CHECK((once - tenfold).norm() < 1e-6);
  }
}

// The slope that it returns is the one of its answer by the force put in.
void ItsHessianIsItsSlope() {
  ConstraintWorkspace workspace;
  for (int k = 0; k < 30; ++k) {
    ConstraintProblem problem = RandomProblem(5);
    const ConstraintSolution at =
        SolveConstraintProblem(problem, Vec6::Zero(), &workspace);
    const Vec6 force = 1e-4 * RandomVector();
    problem.r += force;
    const ConstraintSolution beside =
        SolveConstraintProblem(problem, Vec6::Zero(), &workspace);
    if (!at.hessian.isApprox(beside.hessian)) continue;  // across a kink
    const Vec6 moved = beside.motion - at.motion;
    CHECK((at.hessian * moved - force).norm() < 1e-5 * force.norm());
  }
}

void ABoundOnIterationsIsReported() {
  ConstraintWorkspace workspace;
  const ConstraintProblem problem = RandomProblem(5);
  CHECK(SolveConstraintProblem(problem, 10 * RandomVector(), &workspace, 0)
            .is_bounded);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  using namespace drake_haptics;
  ItIsTheOneCaseThatFits();
  ManyHardSpringsAreSolved();
  ADuplicateOfAHardSpringChangesNothing();
  ItsHessianIsItsSlope();
  ABoundOnIterationsIsReported();
  return FailedChecks() > 0;
}
