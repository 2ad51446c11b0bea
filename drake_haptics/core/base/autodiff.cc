#include "base/autodiff.h"

namespace drake_haptics {
namespace {

// The number with derivatives f a' + g b', where a constant has none.
AutoDiff Sum(double value, double f, const AutoDiff& a, double g,
             const AutoDiff& b) {
  if (b.derivatives().size() == 0) return {value, f * a.derivatives()};
  if (a.derivatives().size() == 0) return {value, g * b.derivatives()};
  return {value, f * a.derivatives() + g * b.derivatives()};
}

}  // namespace

AutoDiff::AutoDiff(double value, const Eigen::VectorXd& derivatives)
    : value_(value), derivatives_(derivatives) {}
AutoDiff::AutoDiff(const AutoDiff&) = default;
AutoDiff::AutoDiff(AutoDiff&&) noexcept = default;
AutoDiff& AutoDiff::operator=(const AutoDiff&) = default;
AutoDiff& AutoDiff::operator=(AutoDiff&&) noexcept = default;
AutoDiff::~AutoDiff() = default;

AutoDiff& AutoDiff::operator+=(const AutoDiff& b) { return *this = *this + b; }
AutoDiff& AutoDiff::operator-=(const AutoDiff& b) { return *this = *this - b; }
AutoDiff& AutoDiff::operator*=(const AutoDiff& b) { return *this = *this * b; }
AutoDiff& AutoDiff::operator/=(const AutoDiff& b) { return *this = *this / b; }

AutoDiff operator-(const AutoDiff& a) { return {-a.value(), -a.derivatives()}; }

AutoDiff operator+(const AutoDiff& a, const AutoDiff& b) {
  return Sum(a.value() + b.value(), 1, a, 1, b);
}

AutoDiff operator-(const AutoDiff& a, const AutoDiff& b) {
  return Sum(a.value() - b.value(), 1, a, -1, b);
}

AutoDiff operator*(const AutoDiff& a, const AutoDiff& b) {
  return Sum(a.value() * b.value(), b.value(), a, a.value(), b);
}

AutoDiff operator/(const AutoDiff& a, const AutoDiff& b) {
  const double quotient = a.value() / b.value();
  const double square = b.value() * b.value();
  if (b.derivatives().size() == 0) {
    return {quotient, a.derivatives() * (1 / b.value())};
  }
  if (a.derivatives().size() == 0) {
    return {quotient, b.derivatives() * (-a.value() / square)};
  }
  AutoDiff c = Sum(quotient, b.value(), a, -a.value(), b);
  c.derivatives() *= 1 / square;
  return c;
}

AutoDiff abs(const AutoDiff& a) { return a.value() < 0 ? -a : a; }

AutoDiff sqrt(const AutoDiff& a) {
  const double root = std::sqrt(a.value());
  return {root, a.derivatives() * (0.5 / root)};
}

AutoDiff sin(const AutoDiff& a) {
  return {std::sin(a.value()), a.derivatives() * std::cos(a.value())};
}

AutoDiff cos(const AutoDiff& a) {
  return {std::cos(a.value()), a.derivatives() * -std::sin(a.value())};
}

AutoDiff asin(const AutoDiff& a) {
  const double cosine = std::sqrt(1 - a.value() * a.value());
  return {std::asin(a.value()), a.derivatives() * (1 / cosine)};
}

AutoDiff atan2(const AutoDiff& y, const AutoDiff& x) {
  AutoDiff angle =
      Sum(std::atan2(y.value(), x.value()), x.value(), y, -y.value(), x);
  angle.derivatives() /= y.value() * y.value() + x.value() * x.value();
  return angle;
}

}  // namespace drake_haptics
