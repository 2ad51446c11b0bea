#include "base/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace drake_haptics {

SymmetricEigen DecomposeSymmetric(const Mat6& matrix) {
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace drake_haptics
