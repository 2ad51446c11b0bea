#include "base/positive_semidefinite.h"

#include <Eigen/Cholesky>

#include "base/symmetric_eigen.h"

namespace drake_haptics {
namespace {

// A difference below this share of the largest entry is round-off.
constexpr double kRoundOff = 1e-9;
// A negative eigenvalue within this share of that entry counts as zero.
constexpr double kSingular = 1e-13;

// A Cholesky decomposition costs a fraction of the eigenvalues.
bool IsPassive(const Mat6& symmetric, double size) {
  const Mat6 lifted = symmetric + kSingular * size * Mat6::Identity();
  return lifted.llt().info() == Eigen::Success;
}

}  // namespace

Mat6 ProjectToPositiveSemidefinite(const Mat6& matrix, bool* changed) {
  Vec6 length;
  length << Vec3::Constant(1 / kHandleLength), Vec3::Ones();
  const Mat6 even = length.asDiagonal() * matrix * length.asDiagonal();
  const double size = even.cwiseAbs().maxCoeff();
  if (size == 0) return Mat6::Zero();
  const Mat6 symmetric = 0.5 * (even + even.transpose());
  Mat6 passive = symmetric;
  if (!IsPassive(symmetric, size)) {
    const SymmetricEigen eigen = DecomposeSymmetric(symmetric);
    passive = eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() *
              eigen.vectors.transpose();
  }
  if ((passive - even).cwiseAbs().maxCoeff() > kRoundOff * size) {
    *changed = true;
  }
  return length.cwiseInverse().asDiagonal() * passive *
         length.cwiseInverse().asDiagonal();
}

}  // namespace drake_haptics
