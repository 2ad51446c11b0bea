#pragma once

#include "types.h"

namespace drake_haptics {

/// A wrench on the tool with its local linear model, at the tool's origin To
/// in the world frame: F(δ, V + ΔV) ≈ F − K δ − B ΔV, where δ is the tool's
/// displacement [rotation vector (rad); translation (m)]. The order is Drake's:
/// rotational first.
struct WrenchModel {
  Vec6 F = Vec6::Zero();  ///< [torque (N·m); force (N)]
  Mat6 K = Mat6::Zero();  ///< stiffness
  Mat6 B = Mat6::Zero();  ///< damping

  WrenchModel& operator+=(const WrenchModel& other) {
    F += other.F;
    K += other.K;
    B += other.B;
    return *this;
  }
};

/// Number of entries of a wrench model as a vector: F, K by rows, B by rows.
inline constexpr int kWrenchModelSize = 6 + 36 + 36;
using WrenchModelVector = Eigen::Matrix<double, kWrenchModelSize, 1>;

WrenchModelVector ToVector(const WrenchModel& model);
WrenchModel FromVector(const WrenchModelVector& vector);

}  // namespace drake_haptics
