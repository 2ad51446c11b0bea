#pragma once

#include "base/autodiff.h"
#include "base/types.h"

namespace drake_haptics {

/// A wrench on the tool with its local linear model, at the tool's origin To
/// in the world frame: F(δ, V + ΔV) ≈ F − K δ − B ΔV, where δ is the tool's
/// displacement [rotation vector (rad); translation (m)]. The order is Drake's:
/// rotational first.
template <typename T>
struct WrenchModelOf {
  Vec6Of<T> F = Vec6Of<T>::Zero();  ///< [torque (N·m); force (N)]
  Mat6Of<T> K = Mat6Of<T>::Zero();  ///< stiffness
  Mat6Of<T> B = Mat6Of<T>::Zero();  ///< damping

  WrenchModelOf& operator+=(const WrenchModelOf& other) {
    F += other.F;
    K += other.K;
    B += other.B;
    return *this;
  }
};
using WrenchModel = WrenchModelOf<double>;

/// Number of entries of a wrench model as a vector: F, K by rows, B by rows.
inline constexpr int kWrenchModelSize = 6 + 36 + 36;
template <typename T>
using WrenchModelVectorOf = Eigen::Matrix<T, kWrenchModelSize, 1>;
using WrenchModelVector = WrenchModelVectorOf<double>;

template <typename T>
WrenchModelVectorOf<T> ToVector(const WrenchModelOf<T>& model);
template <typename T>
WrenchModelOf<T> ToWrenchModel(
    const Eigen::Matrix<T, kWrenchModelSize, 1>& vector);

}  // namespace drake_haptics
