#include "skin_forces.h"

#include <Eigen/Cholesky>
#include <vector>

namespace drake_haptics {
namespace {

using Indices = std::vector<Eigen::Index>;

// Pivots in blocks are few, but nothing proves that they end; single ones by
// least index do (Murty 1974).
constexpr int kBlockPivots = 8;
// What rounding leaves of a zero, relative to the largest depth.
constexpr double kNoise = 1e-12;

// The equations of the contacts that push.
struct Pressed {
  Indices chosen;
  Eigen::LLT<Eigen::MatrixXd> factor;

  Pressed(const Eigen::MatrixXd& C, const std::vector<char>& is_pushing) {
    for (std::size_t i = 0; i < is_pushing.size(); ++i) {
      if (is_pushing[i]) chosen.push_back(static_cast<Eigen::Index>(i));
    }
    Eigen::MatrixXd part(size(), size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      for (Eigen::Index j = 0; j < size(); ++j) {
        part(i, j) = C(chosen[i], chosen[j]);
      }
    }
    factor.compute(part);
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(chosen.size()); }

  Eigen::VectorXd Compression(const Eigen::VectorXd& w) const {
    Eigen::VectorXd part(size());
    for (Eigen::Index i = 0; i < size(); ++i) part[i] = w[chosen[i]];
    factor.solveInPlace(part);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(w.size());
    for (Eigen::Index i = 0; i < size(); ++i) all[chosen[i]] = part[i];
    return all;
  }

  Eigen::MatrixXd Coupling(Eigen::Index count) const {
    Eigen::MatrixXd part = Eigen::MatrixXd::Identity(size(), size());
    factor.solveInPlace(part);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < size(); ++i) {
      for (Eigen::Index j = 0; j < size(); ++j) {
        all(chosen[i], chosen[j]) = part(i, j);
      }
    }
    return all;
  }
};

// Whether a contact is on the wrong side of its condition: it pulls, or it is
// left out and overlaps.
bool IsWrong(bool is_pushing, double compression, double overlap,
             double noise) {
  return is_pushing ? compression < -noise : overlap > noise;
}

}  // namespace

SkinForces SolveSkin(const Eigen::MatrixXd& C, const Eigen::VectorXd& w) {
  const Eigen::Index n = w.size();
  const double noise = kNoise * w.maxCoeff();
  std::vector<char> is_pushing(n, 1);
  const Eigen::Index most = kBlockPivots + 4 * n * n;
  for (Eigen::Index pivot = 0;; ++pivot) {
    const Pressed pressed(C, is_pushing);
    const Eigen::VectorXd compression = pressed.Compression(w);
    const Eigen::VectorXd overlap = w - C * compression;
    bool is_done = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!IsWrong(is_pushing[i], compression[i], overlap[i], noise)) continue;
      is_done = false;
      is_pushing[i] = !is_pushing[i];
      if (pivot >= kBlockPivots) break;
    }
    if (is_done || pivot == most) {
      return {compression.cwiseMax(0.0), pressed.Coupling(n)};
    }
  }
}

SkinForcesOf<AutoDiff> SolveSkin(const MatrixOf<AutoDiff>& C,
                                 const VectorOf<AutoDiff>& w) {
  const SkinForces forces = SolveSkin(ValuesOf(C), ValuesOf(w));
  const Eigen::Index variables = w.size() > 0 ? w[0].derivatives().size() : 0;
  const auto with_variables = [&](double value) {
    return AutoDiff(value, Eigen::VectorXd::Zero(variables));
  };
  SkinForcesOf<AutoDiff> found{forces.compression.unaryExpr(with_variables),
                               forces.coupling.unaryExpr(with_variables)};
  Indices chosen;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    if (forces.coupling(i, i) > 0) chosen.push_back(i);
  }
  const Eigen::MatrixXd H = forces.coupling(chosen, chosen);
  const Eigen::VectorXd pressed = forces.compression(chosen);
  const auto part = [](const AutoDiff& x, Eigen::Index k) {
    return x.derivatives().size() > 0 ? x.derivatives()[k] : 0.0;
  };
  for (Eigen::Index k = 0; k < variables; ++k) {
    const Eigen::MatrixXd dC =
        C(chosen, chosen).unaryExpr([&](const AutoDiff& x) {
          return part(x, k);
        });
    const Eigen::VectorXd dw =
        w(chosen).unaryExpr([&](const AutoDiff& x) { return part(x, k); });
    const Eigen::VectorXd by_force = H * (dw - dC * pressed);
    const Eigen::MatrixXd by_coupling = -H * dC * H;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      found.compression[chosen[i]].derivatives()[k] = by_force[i];
      for (std::size_t j = 0; j < chosen.size(); ++j) {
        found.coupling(chosen[i], chosen[j]).derivatives()[k] =
            by_coupling(i, j);
      }
    }
  }
  return found;
}

}  // namespace drake_haptics
