#include "passive_part.h"

#include <Eigen/Eigenvalues>

namespace drake_haptics {
namespace {

// Below this part of the largest entry a difference is round-off.
constexpr double kRoundOff = 1e-9;

}  // namespace

Mat6 PassivePart(const Mat6& matrix, bool* changed) {
  Vec6 length;
  length << Vec3::Constant(1 / kHandleLength), Vec3::Ones();
  const Mat6 even = length.asDiagonal() * matrix * length.asDiagonal();
  const double size = even.cwiseAbs().maxCoeff();
  if (size == 0) return Mat6::Zero();
  const Mat6 symmetric = 0.5 * (even + even.transpose());
  Eigen::SelfAdjointEigenSolver<Mat6> solver(symmetric);
  const Vec6 values = solver.eigenvalues();
  Mat6 passive = symmetric;
  if (values.minCoeff() < 0) {
    passive = solver.eigenvectors() * values.cwiseMax(0).asDiagonal() *
              solver.eigenvectors().transpose();
  }
  if ((passive - even).cwiseAbs().maxCoeff() > kRoundOff * size) {
    *changed = true;
  }
  return length.cwiseInverse().asDiagonal() * passive *
         length.cwiseInverse().asDiagonal();
}

}  // namespace drake_haptics
