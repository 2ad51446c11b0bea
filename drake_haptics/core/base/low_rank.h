#pragma once

#include <Eigen/Core>
#include <cmath>

namespace drake_haptics {

/// Returns the features Φ, with a column φ for each of `count` items, such that
/// K_ab = φ_aᵀ φ_b to within `tolerance`. This is Cholesky's factorization with
/// the largest remaining diagonal entry as pivot (Harbrecht, Peters and
/// Schneider 2012). It ends when the remaining diagonal is within the
/// tolerance. The rest of K is positive semidefinite, so that its other entries
/// are too. Similar items need few features however many they are; the time
/// grows with the count and the square of the number of features.
/// @param diagonal diagonal entry of K, the same for all items.
/// @param entry function of a and b that returns K_ab; K is positive
///     semidefinite.
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
