#pragma once

#include <Eigen/Core>
#include <cmath>

namespace drake_haptics {

/// The features Φ, a column for each of `count` things, with which
/// K_ab = φ_aᵀ φ_b to within `tolerance`. Cholesky's factor in the order in
/// which what is left of the diagonal is largest (Harbrecht, Peters and
/// Schneider 2012): it ends when all of that is within the tolerance. What is
/// left of K is positive semidefinite, so that its other entries are too.
/// Things that are nearly alike take few features however many they are; the
/// time grows with the count and the square of the features.
/// @param diagonal of K, the same for all.
/// @param entry K_ab of a and b, positive semidefinite.
template <typename Entry>
Eigen::MatrixXd FindFeatures(Eigen::Index count, double diagonal,
                             double tolerance, const Entry& entry) {
  Eigen::VectorXd left = Eigen::VectorXd::Constant(count, diagonal);
  Eigen::MatrixXd factor(count, count);
  Eigen::Index rank = 0, next = 0;
  for (; rank < count && left.maxCoeff(&next) > tolerance; ++rank) {
    auto column = factor.col(rank);
    for (Eigen::Index a = 0; a < count; ++a) column[a] = entry(a, next);
    column.noalias() -=
        factor.leftCols(rank) * factor.row(next).head(rank).transpose();
    column /= std::sqrt(left[next]);
    left.array() -= column.array().square();
    left[next] = 0;
  }
  return factor.leftCols(rank).transpose();
}

}  // namespace drake_haptics
