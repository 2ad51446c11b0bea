#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/autodiff.h"

namespace drake_haptics {

/// Derivative of the clusters' compressions by their depths, H = dλ/dw. With
/// slopes r_i and features φ_a of the directions a, whose products are the
/// common compliance (compliance_forces.h),
///   H_ij = [i = j] r_i − r_i r_j φ_aᵀ M φ_b,  M = (1 + Σ_i r_i φ_a φ_aᵀ)⁻¹.
/// Its size grows with the clusters and the directions, not with their squares.
struct CompressionJacobian {
  struct Member {
    double slope = 0;  ///< r_i, 0 where the cluster does not push
    /// Index in `skins`, one per object; −1 for a single cluster, with H = 1.
    std::int32_t skin = -1;
    std::int32_t direction = 0;
  };
  struct Skin {
    Eigen::MatrixXd features;  ///< φ, a column for each direction
    Eigen::MatrixXd factor;    ///< L in its lower half, L Lᵀ = M⁻¹
  };
  /// One for each cluster, or none if H is the identity.
  std::vector<Member> members;
  std::vector<Skin> skins;  ///< one per object with several clusters

  bool empty() const { return members.empty(); }
  void clear() {
    members.clear();
    skins.clear();
  }

  /// H of two clusters.
  double operator()(std::size_t i, std::size_t j) const {
    const double own = i != j ? 0.0 : empty() ? 1.0 : members[i].slope;
    if (empty() || members[i].skin != members[j].skin || members[i].skin < 0) {
      return own;
    }
    const auto& [features, factor] = skins[members[i].skin];
    const auto L = factor.triangularView<Eigen::Lower>();
    const Eigen::VectorXd one = L.solve(features.col(members[i].direction));
    const Eigen::VectorXd other = L.solve(features.col(members[j].direction));
    return own - members[i].slope * members[j].slope * one.dot(other);
  }
};

/// The same with derivatives. Equal normals may turn apart, so all of H is
/// stored, object by object.
struct MovingCompressionJacobian {
  /// The row of a cluster covers the clusters of its object: `count` from
  /// `first` on.
  struct Member {
    std::int32_t first = 0;
    std::int32_t count = 0;
    std::size_t row = 0;  ///< start of its row in `together`
  };
  std::vector<Member> members;     ///< as in CompressionJacobian
  std::vector<AutoDiff> together;  ///< H by rows, one object after another
  /// The same without derivatives, so that sums agree to the last bit.
  CompressionJacobian values;

  bool empty() const { return members.empty(); }
  void clear() {
    members.clear();
    together.clear();
    values.clear();
  }

  /// H of two clusters.
  AutoDiff operator()(std::size_t i, std::size_t j) const {
    if (empty()) return AutoDiff(i == j ? 1.0 : 0.0);
    const Member& one = members[i];
    if (members[j].first != one.first) return AutoDiff(0.0);
    return together[one.row + j - one.first];
  }
};

template <typename T>
using CompressionJacobianOf =
    std::conditional_t<std::is_same_v<T, double>, CompressionJacobian,
                       MovingCompressionJacobian>;

}  // namespace drake_haptics
