#pragma once

#include <Eigen/Core>
#include <cmath>
#include <compare>
#include <stdexcept>
#include <string>
#include <vector>

namespace drake_haptics {

/// A number with its derivatives with respect to any number of variables. Code
/// to differentiate is a template over the scalar, which is double in a tick
/// and AutoDiff for gradients: one derivation serves both.
///
/// All is compiled once and called, even copies: Eigen::AutoDiffScalar, whose
/// expressions are inlined wherever a gradient is, takes the compiler several
/// times longer.
class AutoDiff {
 public:
  AutoDiff() = default;
  /// A constant, whose derivatives are empty.
  AutoDiff(double value) : value_(value) {}
  AutoDiff(double value, const Eigen::VectorXd& derivatives);
  AutoDiff(const AutoDiff&);
  AutoDiff(AutoDiff&&) noexcept;
  AutoDiff& operator=(const AutoDiff&);
  AutoDiff& operator=(AutoDiff&&) noexcept;
  ~AutoDiff();

  double value() const { return value_; }
  double& value() { return value_; }
  const Eigen::VectorXd& derivatives() const { return derivatives_; }
  Eigen::VectorXd& derivatives() { return derivatives_; }

  AutoDiff& operator+=(const AutoDiff& other);
  AutoDiff& operator-=(const AutoDiff& other);
  AutoDiff& operator*=(const AutoDiff& other);
  AutoDiff& operator/=(const AutoDiff& other);

 private:
  double value_ = 0;
  Eigen::VectorXd derivatives_;
};

AutoDiff operator-(const AutoDiff& a);
AutoDiff operator+(const AutoDiff& a, const AutoDiff& b);
AutoDiff operator-(const AutoDiff& a, const AutoDiff& b);
AutoDiff operator*(const AutoDiff& a, const AutoDiff& b);
AutoDiff operator/(const AutoDiff& a, const AutoDiff& b);
AutoDiff abs(const AutoDiff& a);
AutoDiff sqrt(const AutoDiff& a);
AutoDiff sin(const AutoDiff& a);
AutoDiff cos(const AutoDiff& a);
AutoDiff asin(const AutoDiff& a);
AutoDiff atan2(const AutoDiff& y, const AutoDiff& x);

inline bool operator==(const AutoDiff& a, const AutoDiff& b) {
  return a.value() == b.value();
}
inline std::partial_ordering operator<=>(const AutoDiff& a, const AutoDiff& b) {
  return a.value() <=> b.value();
}

}  // namespace drake_haptics

/// Eigen's matrices of the scalar. Its operations cost too much for a loop of
/// them to be unrolled.
template <>
struct Eigen::NumTraits<drake_haptics::AutoDiff> : Eigen::NumTraits<double> {
  using Real = drake_haptics::AutoDiff;
  using NonInteger = drake_haptics::AutoDiff;
  using Nested = drake_haptics::AutoDiff;
  enum {
    RequireInitialization = 1,
    ReadCost = HugeCost,
    AddCost = HugeCost,
    MulCost = HugeCost
  };
};

template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<drake_haptics::AutoDiff, double, Operation> {
  using ReturnType = drake_haptics::AutoDiff;
};

template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, drake_haptics::AutoDiff, Operation> {
  using ReturnType = drake_haptics::AutoDiff;
};

namespace drake_haptics {

template <typename T>
using VectorOf = Eigen::Matrix<T, Eigen::Dynamic, 1>;
template <typename T>
using MatrixOf = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <typename T>
using Vec3Of = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Mat3Of = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Vec6Of = Eigen::Matrix<T, 6, 1>;
template <typename T>
using Mat6Of = Eigen::Matrix<T, 6, 6>;

/// The value without derivatives, on which branches depend.
inline double ValueOf(double x) { return x; }
inline double ValueOf(const AutoDiff& x) { return x.value(); }

/// The values of a matrix.
template <typename Derived>
auto ValuesOf(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix
      .unaryExpr([](const typename Derived::Scalar& x) { return ValueOf(x); })
      .eval();
}

/// |v|, with zero derivatives at its kink v = 0.
template <typename T>
T LengthOf(const Eigen::Matrix<T, 3, 1>& v) {
  using std::sqrt;
  const T square = v.squaredNorm();
  if (ValueOf(square) == 0) return T(0.0);
  return sqrt(square);
}

/// n numbers with their derivatives with respect to D variables: value (n),
/// gradient (n, D).
struct AutoDiffVector {
  Eigen::VectorXd value;
  Eigen::MatrixXd gradient;

  Eigen::Index size() const { return value.size(); }
  Eigen::Index num_derivatives() const { return gradient.cols(); }

  /// Entry i as a scalar.
  AutoDiff operator()(Eigen::Index i) const {
    return AutoDiff(value[i], gradient.row(i).transpose());
  }
};

/// @throws std::invalid_argument unless the vector has `Size` entries; `what`
///         names it in the message.
template <int Size>
Eigen::Matrix<AutoDiff, Size, 1> ToScalars(const AutoDiffVector& vector,
                                           const char* what) {
  if (vector.size() != Size) {
    throw std::invalid_argument(std::string(what) + " must have " +
                                std::to_string(Size) + " entries, has " +
                                std::to_string(vector.size()));
  }
  Eigen::Matrix<AutoDiff, Size, 1> scalars;
  for (int i = 0; i < Size; ++i) scalars[i] = vector(i);
  return scalars;
}

/// Returns the number of variables D that all vectors share.
/// @throws std::invalid_argument if they differ.
template <typename... Vectors>
Eigen::Index CommonNumDerivatives(const AutoDiffVector& first,
                                  const Vectors&... others) {
  const Eigen::Index num_derivatives = first.num_derivatives();
  if (((others.num_derivatives() != num_derivatives) || ...)) {
    throw std::invalid_argument(
        "all arguments must have derivatives by the same variables");
  }
  return num_derivatives;
}

/// Replaces the value; a constant gets zero derivatives.
inline void SetValue(double value, Eigen::Index num_derivatives, AutoDiff* x) {
  x->value() = value;
  if (x->derivatives().size() == 0) x->derivatives().setZero(num_derivatives);
}

/// Replaces the values of a vector's entries likewise.
template <typename Values, typename Vector>
void SetValues(const Values& values, Eigen::Index num_derivatives,
               Vector* vector) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    SetValue(values[i], num_derivatives, &(*vector)[i]);
  }
}

/// Returns values and gradients. Constants get zero derivatives.
template <typename Derived>
AutoDiffVector ToAutoDiffVector(const Eigen::MatrixBase<Derived>& scalars,
                                Eigen::Index num_derivatives) {
  AutoDiffVector vector{ValuesOf(scalars),
                        Eigen::MatrixXd::Zero(scalars.size(), num_derivatives)};
  for (Eigen::Index i = 0; i < scalars.size(); ++i) {
    const AutoDiff& scalar = scalars[i];  // a copy if it is an expression
    const Eigen::VectorXd& gradient = scalar.derivatives();
    if (gradient.size() > 0) vector.gradient.row(i) = gradient.transpose();
  }
  return vector;
}

}  // namespace drake_haptics
