#include "law/compliance_forces.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace drake_haptics {
namespace {

// Round-off of a zero, relative to the largest depth.
constexpr double kNoise = 1e-12;

// Sums over the contacts that push, by direction.
class Pressed {
 public:
  explicit Pressed(const Skin& skin)
      : skin_(skin),
        slope_(Eigen::VectorXd::Zero(skin.features.cols())),
        sum_(Eigen::MatrixXd::Identity(skin.features.rows(),
                                       skin.features.rows())),
        changed_(skin.features.rows(), skin.features.cols()) {}

  // Solves for the yield of the skin, u = M Σ r w φ, and how much deeper each
  // contact is, w − φᵀ u: λ / r, above 0, where it pushes.
  void Press(const std::vector<char>& is_pushing) {
    change_ = slope_;
    slope_.setZero();
    load_.setZero(slope_.size());
    for (std::size_t i = 0; i < is_pushing.size(); ++i) {
      if (!is_pushing[i]) continue;
      slope_[skin_.direction[i]] += skin_.slope[i];
      load_[skin_.direction[i]] += skin_.slope[i] * skin_.depth[i];
    }
    change_ = slope_ - change_;
    Add(change_);
    factor_.compute(sum_);
    yield = factor_.solve(skin_.features * load_);
    yields_.noalias() = skin_.features.transpose() * yield;
    rest = skin_.depth;
    for (Eigen::Index i = 0; i < rest.size(); ++i) {
      rest[i] -= yields_[skin_.direction[i]];
    }
  }

  const Eigen::MatrixXd& factor() const { return factor_.matrixLLT(); }

  Eigen::VectorXd yield, rest;

 private:
  // Adds Σ change φ φᵀ, over the directions with rising slopes, then over those
  // with falling ones.
  void Add(const Eigen::VectorXd& change) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Index count = 0;
      for (Eigen::Index a = 0; a < change.size(); ++a) {
        if (!(sign * change[a] > 0)) continue;
        changed_.col(count++) =
            std::sqrt(std::abs(change[a])) * skin_.features.col(a);
      }
      if (count == 0) continue;
      sum_.selfadjointView<Eigen::Lower>().rankUpdate(changed_.leftCols(count),
                                                      sign);
    }
  }

  const Skin& skin_;
  Eigen::VectorXd slope_;                   // sums of r by direction
  Eigen::MatrixXd sum_;                     // 1 + Σ r φ φᵀ, its lower half
  Eigen::VectorXd change_, load_, yields_;  // by direction, of one call
  Eigen::MatrixXd changed_;  // √|change| φ, a column for each change
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

// Whether the contacts that push are those that are deeper than the skin
// yields.
bool IsRight(const Eigen::VectorXd& rest, double noise,
             const std::vector<char>& is_pushing) {
  for (std::size_t i = 0; i < is_pushing.size(); ++i) {
    if (is_pushing[i] ? rest[i] < -noise : rest[i] > noise) return false;
  }
  return true;
}

// Returns the share of a step at which the energy is least. The whole step
// would lead to the least energy if no contact began or ceased to push on the
// way.
// @param rest, next how much deeper each contact is than the skin yields,
//     before and after the step.
// @param square squared length of the step.
double FindLeast(const Eigen::VectorXd& slope, const Eigen::VectorXd& rest,
                 const Eigen::VectorXd& next, double square) {
  struct Kink {
    double at;      // a contact begins or ceases to push here
    double change;  // of the curvature
  };
  std::vector<Kink> kinks;
  kinks.reserve(rest.size());
  double curvature = square;
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    const double rise = next[i] - rest[i];
    const double own = slope[i] * rise * rise;
    if (rest[i] > 0) curvature += own;
    if (rest[i] > 0 ? rise < 0 : rise > 0) {
      kinks.push_back({-rest[i] / rise, rest[i] > 0 ? -own : own});
    }
  }
  std::sort(kinks.begin(), kinks.end(),
            [](const Kink& p, const Kink& q) { return p.at < q.at; });
  double at = 0, climb = -curvature;
  for (const Kink& kink : kinks) {
    const double there = climb + curvature * (kink.at - at);
    if (there >= 0) break;
    at = kink.at;
    climb = there;
    curvature = std::max(curvature + kink.change, square);
  }
  return at - climb / curvature;
}

// Forces of the contacts that push.
ComplianceForces Answer(const Skin& skin, const Pressed& pressed,
                        const std::vector<char>& is_pushing,
                        const Eigen::VectorXd& rest) {
  const Eigen::Index n = skin.depth.size();
  ComplianceForces found{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n),
                         pressed.factor()};
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!is_pushing[i]) continue;
    // Rounding may leave it below zero.
    found.compression[i] = skin.slope[i] * std::max(0.0, rest[i]);
    found.slope[i] = skin.slope[i];
  }
  return found;
}

}  // namespace

ComplianceForces SolveSkin(const Skin& skin, int max_steps) {
  const double noise = kNoise * skin.depth.maxCoeff();
  // The skin has not yielded yet: all push.
  std::vector<char> is_pushing(skin.depth.size(), 1);
  Eigen::VectorXd yield = Eigen::VectorXd::Zero(skin.features.rows());
  Eigen::VectorXd rest = skin.depth;
  Pressed pressed(skin);
  for (int step = 0;; ++step) {
    pressed.Press(is_pushing);
    if (IsRight(pressed.rest, noise, is_pushing)) {
      return Answer(skin, pressed, is_pushing, pressed.rest);
    }
    if (step == max_steps) {
      ComplianceForces found = Answer(skin, pressed, is_pushing, rest);
      found.is_bounded = true;
      return found;
    }
    const double share = FindLeast(skin.slope, rest, pressed.rest,
                                   (pressed.yield - yield).squaredNorm());
    yield += share * (pressed.yield - yield);
    rest += share * (pressed.rest - rest);
    for (std::size_t i = 0; i < is_pushing.size(); ++i) {
      is_pushing[i] = rest[i] > 0;
    }
  }
}

MovingComplianceForces SolveSkin(const MovingCompression& skin,
                                 const std::vector<char>& is_pushing) {
  // C of the contacts that push. The others have rows of the identity.
  MatrixOf<AutoDiff> C = skin.common;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    if (is_pushing[i]) {
      C(i, i) += 1.0 / skin.slope[i];
      continue;
    }
    C.row(i).setZero();
    C.col(i).setZero();
    C(i, i) = AutoDiff(1);
  }
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(C.rows(), C.cols());
  Eigen::LLT<Eigen::MatrixXd>(ValuesOf(C)).solveInPlace(H);
  Eigen::Index variables = 0;
  for (Eigen::Index i = 0; i < C.size(); ++i) {
    variables = std::max(variables, C.data()[i].derivatives().size());
  }
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    if (!is_pushing[i]) H(i, i) = 0;
  }
  MovingComplianceForces found;
  found.together = H.unaryExpr([&](double value) {
    return AutoDiff(value, Eigen::VectorXd::Zero(variables));
  });
  for (Eigen::Index k = 0; k < variables; ++k) {
    const Eigen::MatrixXd dC = C.unaryExpr([&](const AutoDiff& x) {
      return x.derivatives().size() > 0 ? x.derivatives()[k] : 0.0;
    });
    const Eigen::MatrixXd dH = -H * dC * H;
    for (Eigen::Index i = 0; i < C.size(); ++i) {
      found.together.data()[i].derivatives()[k] = dH.data()[i];
    }
  }
  found.compression = found.together * skin.depth;
  for (AutoDiff& compression : found.compression) {
    // Rounding may leave it below zero.
    if (!(compression > 0.0)) compression = AutoDiff(0.0);
  }
  return found;
}

}  // namespace drake_haptics
