#include "skin_forces.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace drake_haptics {
namespace {

// Pivots in blocks that leave no fewer on the wrong side than ever before.
// Nothing proves that such end; single ones by least index do (Murty 1974).
constexpr int kBlockPivots = 8;
// What rounding leaves of a zero, relative to the largest depth.
constexpr double kNoise = 1e-12;

// The directions of the contacts that push, each as one contact.
template <typename T>
struct Pressed {
  VectorOf<T> slope;  // R, 0 where none pushes
  VectorOf<T> depth;  // means over the contacts that push, weighted by r

  Pressed(const SkinOf<T>& skin, const std::vector<char>& is_pushing)
      : slope(VectorOf<T>::Zero(skin.common.rows())),
        depth(VectorOf<T>::Zero(skin.common.rows())) {
    for (std::size_t i = 0; i < is_pushing.size(); ++i) {
      if (!is_pushing[i]) continue;
      slope[skin.direction[i]] += skin.slope[i];
      depth[skin.direction[i]] += skin.slope[i] * skin.depth[i];
    }
    for (Eigen::Index a = 0; a < slope.size(); ++a) {
      if (slope[a] != 0.0) depth[a] /= slope[a];
    }
  }

  // G + 1/R between them, and apart from them a 1 where none pushes.
  MatrixOf<T> Compliance(const SkinOf<T>& skin) const {
    MatrixOf<T> C = skin.common;
    for (Eigen::Index a = 0; a < slope.size(); ++a) {
      if (slope[a] != 0.0) {
        C(a, a) += 1.0 / slope[a];
        continue;
      }
      C.row(a).setZero();
      C.col(a).setZero();
      C(a, a) = T(1);
    }
    return C;
  }

  // λ of a contact that pushes, where its direction bears `force`.
  T Compression(const SkinOf<T>& skin, std::size_t i, const T& force) const {
    const Eigen::Index a = skin.direction[i];
    return skin.slope[i] * (force / slope[a] + (skin.depth[i] - depth[a]));
  }
};

// The forces of the contacts that push; `inverse` is that of the compliance.
template <typename T>
SkinForcesOf<T> Answer(const SkinOf<T>& skin, const Pressed<T>& pressed,
                       const std::vector<char>& is_pushing,
                       MatrixOf<T> inverse) {
  const Eigen::Index n = skin.depth.size();
  for (Eigen::Index a = 0; a < inverse.rows(); ++a) {
    if (pressed.slope[a] == 0.0) inverse(a, a) = T(0);
  }
  const VectorOf<T> force = inverse * pressed.depth;
  SkinForcesOf<T> found{VectorOf<T>::Zero(n), VectorOf<T>::Zero(n),
                        pressed.slope, std::move(inverse)};
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!is_pushing[i]) continue;
    const T compression =
        pressed.Compression(skin, i, force[skin.direction[i]]);
    // What rounding leaves below zero.
    if (compression > 0.0) found.compression[i] = compression;
    found.slope[i] = skin.slope[i];
  }
  return found;
}

// Contacts on the wrong side of their condition: they pull, or are left out and
// overlap. `force` is that of the directions.
void FindWrong(const Skin& skin, const Pressed<double>& pressed,
               const std::vector<char>& is_pushing,
               const Eigen::VectorXd& force, std::vector<std::size_t>* wrong) {
  const double noise = kNoise * skin.depth.maxCoeff();
  wrong->clear();
  for (std::size_t i = 0; i < is_pushing.size(); ++i) {
    const Eigen::Index a = skin.direction[i];
    if (is_pushing[i] ? pressed.Compression(skin, i, force[a]) < -noise
                      : skin.depth[i] - skin.common.col(a).dot(force) > noise) {
      wrong->push_back(i);
    }
  }
}

}  // namespace

SkinForces SolveSkin(const Skin& skin) {
  const auto n = static_cast<std::size_t>(skin.depth.size());
  std::vector<char> is_pushing(n, 1);
  std::vector<std::size_t> wrong;
  std::size_t fewest = n + 1;
  int patience = kBlockPivots;
  const std::size_t most = kBlockPivots + 4 * n * n;
  for (std::size_t pivot = 0;; ++pivot) {
    const Pressed<double> pressed(skin, is_pushing);
    Eigen::MatrixXd C = pressed.Compliance(skin);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(C);
    Eigen::VectorXd force = pressed.depth;
    factor.solveInPlace(force);
    FindWrong(skin, pressed, is_pushing, force, &wrong);
    if (wrong.empty() || pivot == most) {
      Eigen::MatrixXd inverse =
          Eigen::MatrixXd::Identity(force.size(), force.size());
      factor.solveInPlace(inverse);
      return Answer(skin, pressed, is_pushing, std::move(inverse));
    }
    patience = wrong.size() < fewest ? kBlockPivots : std::max(0, patience - 1);
    fewest = std::min(fewest, wrong.size());
    if (patience == 0) wrong.resize(1);
    for (const std::size_t i : wrong) is_pushing[i] = !is_pushing[i];
  }
}

SkinForcesOf<AutoDiff> SolveSkin(const SkinOf<AutoDiff>& skin) {
  const SkinForces forces =
      SolveSkin(Skin{ValuesOf(skin.depth), ValuesOf(skin.slope), skin.direction,
                     ValuesOf(skin.common)});
  std::vector<char> is_pushing;
  for (const double slope : forces.slope) is_pushing.push_back(slope > 0);
  const Pressed<AutoDiff> pressed(skin, is_pushing);
  const MatrixOf<AutoDiff> C = pressed.Compliance(skin);
  const Eigen::MatrixXd& N = forces.together;
  Eigen::Index variables = 0;
  for (Eigen::Index i = 0; i < C.size(); ++i) {
    variables = std::max(variables, C.data()[i].derivatives().size());
  }
  MatrixOf<AutoDiff> inverse = N.unaryExpr([&](double value) {
    return AutoDiff(value, Eigen::VectorXd::Zero(variables));
  });
  for (Eigen::Index k = 0; k < variables; ++k) {
    const Eigen::MatrixXd dC = C.unaryExpr([&](const AutoDiff& x) {
      return x.derivatives().size() > 0 ? x.derivatives()[k] : 0.0;
    });
    const Eigen::MatrixXd dN = -N * dC * N;
    for (Eigen::Index i = 0; i < C.size(); ++i) {
      inverse.data()[i].derivatives()[k] = dN.data()[i];
    }
  }
  return Answer(skin, pressed, is_pushing, std::move(inverse));
}

}  // namespace drake_haptics
