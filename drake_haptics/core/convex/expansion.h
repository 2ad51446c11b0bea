#pragma once

#include <array>
#include <cmath>

namespace drake_haptics {

/// A real number held exactly as a sum of at most N doubles that do not
/// overlap, by increasing magnitude (J. R. Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
/// Exact as long as no product underflows or overflows and the compiler does
/// not contract products into sums (-ffp-contract=off).
template <int N>
class Expansion {
 public:
  int size() const { return size_; }
  double operator[](int i) const { return terms_[i]; }
  void Append(double term) {
    if (term != 0) terms_[size_++] = term;
  }

  /// The sum rounded to a double. Its sign is the sign of the exact number.
  double Round() const {
    double sum = 0;
    for (int i = 0; i < size_; ++i) sum += terms_[i];
    return sum;
  }

  Expansion operator-() const {
    Expansion result;
    for (int i = 0; i < size_; ++i) result.Append(-terms_[i]);
    return result;
  }

 private:
  std::array<double, N> terms_{};
  int size_ = 0;
};

/// a - b exactly.
inline Expansion<2> ExactDifference(double a, double b) {
  const double x = a - b;
  const double b_virtual = a - x;
  const double a_virtual = x + b_virtual;
  Expansion<2> result;
  result.Append((a - a_virtual) + (b_virtual - b));
  result.Append(x);
  return result;
}

/// Sum by merging: theorem 13 of the paper.
template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& e, const Expansion<M>& f) {
  Expansion<N + M> result;
  int i = 0, j = 0;
  double sum = 0;
  while (i < e.size() || j < f.size()) {
    const bool take_e =
        j == f.size() || (i < e.size() && std::abs(e[i]) < std::abs(f[j]));
    const double term = take_e ? e[i++] : f[j++];
    const double x = sum + term;
    const double term_virtual = x - sum;
    result.Append((sum - (x - term_virtual)) + (term - term_virtual));
    sum = x;
  }
  result.Append(sum);
  return result;
}

template <int N, int M>
Expansion<N + M> operator-(const Expansion<N>& e, const Expansion<M>& f) {
  return e + -f;
}

/// Product with one double: theorem 19 of the paper.
template <int N>
Expansion<2 * N> operator*(const Expansion<N>& e, double factor) {
  Expansion<2 * N> result;
  double carry = 0;
  for (int i = 0; i < e.size(); ++i) {
    const double high = e[i] * factor;
    const double low = std::fma(e[i], factor, -high);
    const double sum = carry + low;
    const double low_virtual = sum - carry;
    result.Append((carry - (sum - low_virtual)) + (low - low_virtual));
    carry = high + sum;
    result.Append(sum - (carry - high));
  }
  result.Append(carry);
  return result;
}

/// Product with a difference of two doubles.
template <int N>
Expansion<4 * N> operator*(const Expansion<N>& e, const Expansion<2>& f) {
  Expansion<2 * N> low, high;
  if (f.size() > 0) low = e * f[0];
  if (f.size() > 1) high = e * f[1];
  return low + high;
}

}  // namespace drake_haptics
