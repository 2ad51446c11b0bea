#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

/// The core: everything that must finish inside one tick. It knows neither
/// Drake nor Python. Lengths in m, angles in rad, forces in N, torques in N·m.
namespace drake_haptics {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Pose X_AB of a frame B in a frame A: p_A = R p_B + p. R is a rotation.
template <typename T>
struct PoseOf {
  Eigen::Matrix<T, 3, 3> R = Eigen::Matrix<T, 3, 3>::Identity();
  Eigen::Matrix<T, 3, 1> p = Eigen::Matrix<T, 3, 1>::Zero();

  Eigen::Matrix<T, 3, 1> operator*(const Eigen::Matrix<T, 3, 1>& point) const {
    return R * point + p;
  }
  PoseOf operator*(const PoseOf& other) const {
    return {R * other.R, R * other.p + p};
  }
  template <typename To>
  PoseOf<To> cast() const {
    return {R.template cast<To>(), p.template cast<To>()};
  }
  PoseOf inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};
using Pose = PoseOf<double>;

/// X_AB from poses in the world: the difference of the origins is formed first,
/// so that a scene far from the world's origin loses no precision.
inline Pose RelativePose(const Pose& X_WA, const Pose& X_WB) {
  return {X_WA.R.transpose() * X_WB.R, X_WA.R.transpose() * (X_WB.p - X_WA.p)};
}

/// Kind of a feature of a polytope.
enum class FeatureKind : std::int32_t { kVertex = 0, kEdge = 1, kFacet = 2 };

/// A vertex, edge or facet of a polytope as one integer: index * 4 + kind.
/// Negative means none.
class Feature {
 public:
  static constexpr int kMaxIndex = (1 << 29) - 1;

  Feature() = default;
  Feature(FeatureKind kind, int index)
      : code_(index * 4 + static_cast<std::int32_t>(kind)) {}

  bool is_none() const { return code_ < 0; }
  FeatureKind kind() const { return static_cast<FeatureKind>(code_ & 3); }
  int index() const { return code_ >> 2; }
  std::int32_t code() const { return code_; }
  bool operator==(const Feature&) const = default;

 private:
  std::int32_t code_ = -1;
};

}  // namespace drake_haptics
