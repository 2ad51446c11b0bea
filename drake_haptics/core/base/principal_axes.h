#pragma once

#include <Eigen/Eigenvalues>

#include "base/autodiff.h"

namespace drake_haptics {

/// The value 1 / q of a piecewise linear function q.
template <typename T>
struct Reciprocal {
  T value;
  double slope_of_q;  ///< derivative of q
};

/// A symmetric matrix in its principal axes, smallest eigenvalue first. The
/// axes diagonalize the values, so off-diagonal derivatives change the
/// eigenvalues only to second order.
template <typename T>
class PrincipalAxes {
 public:
  explicit PrincipalAxes(const Eigen::Matrix<T, 2, 2>& matrix) {
    axes_.computeDirect(ValuesOf(matrix));
    in_axes_ = V().transpose() * matrix * V();
  }

  T eigenvalue(int i) const { return in_axes_(i, i); }

  /// Returns the symmetric matrix in which f replaces each eigenvalue; `f`
  /// returns a Reciprocal. The derivatives of off-diagonal entries are scaled
  /// by the divided difference of f (Daleckii and Krein).
  template <typename Function>
  Eigen::Matrix<T, 2, 2> Map(const Function& f) const {
    const Reciprocal<T> first = f(eigenvalue(0)), second = f(eigenvalue(1));
    const T off_diagonal = DividedDifference(first, second) * in_axes_(0, 1);
    Eigen::Matrix<T, 2, 2> mapped;
    mapped << first.value, off_diagonal, off_diagonal, second.value;
    return V() * mapped * V().transpose();
  }

 private:
  // (f(b) − f(a)) / (b − a) of the eigenvalues a and b, which may be equal.
  double DividedDifference(const Reciprocal<T>& f_a,
                           const Reciprocal<T>& f_b) const {
    const double value_a = ValueOf(f_a.value), value_b = ValueOf(f_b.value);
    if (f_a.slope_of_q == f_b.slope_of_q) {
      return -f_a.slope_of_q * value_a * value_b;
    }
    return (value_b - value_a) /
           (axes_.eigenvalues()[1] - axes_.eigenvalues()[0]);
  }

  Eigen::Matrix<T, 2, 2> V() const {
    return axes_.eigenvectors().template cast<T>();
  }

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes_;
  Eigen::Matrix<T, 2, 2> in_axes_;
};

/// Specialization without derivatives.
template <>
class PrincipalAxes<double> {
 public:
  explicit PrincipalAxes(const Eigen::Matrix2d& matrix) {
    axes_.computeDirect(matrix);
  }

  double eigenvalue(int i) const { return axes_.eigenvalues()[i]; }

  template <typename Function>
  Eigen::Matrix2d Map(const Function& f) const {
    const Eigen::Vector2d values(f(eigenvalue(0)).value,
                                 f(eigenvalue(1)).value);
    return axes_.eigenvectors() * values.asDiagonal() *
           axes_.eigenvectors().transpose();
  }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes_;
};

}  // namespace drake_haptics
