#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace drake_haptics {

/// How the compressions of clusters change with their depths, H = dλ/dw, where
/// clusters along one direction have only the sum of their forces in common.
/// With slopes r_i, sums R_a of them over directions a, and N between those,
///   H_ij = [i = j] r_i − [a = b] r_i r_j / R_a + (r_i / R_a) N_ab (r_j / R_b):
/// a direction answers as one contact at its mean depth, and what its contacts
/// are deeper than that they bear by themselves. It is as long as the clusters
/// and the square of the directions, not the square of the clusters.
template <typename T>
struct SkinCouplingOf {
  struct Member {
    T slope{0};  ///< r_i, 0 where the cluster does not push
    std::int32_t direction = 0;
  };
  /// Its row of N covers the directions of its object: `count` from `first` on.
  struct Direction {
    T slope{0};  ///< R_a, 0 where none of its clusters pushes
    std::int32_t first = 0;
    std::int32_t count = 0;
    std::size_t row = 0;  ///< where in `together` its row begins
  };
  /// One for each cluster. None where each has its own: H is the identity.
  std::vector<Member> members;
  std::vector<Direction> directions;
  std::vector<T> together;  ///< N by rows, one object after another

  struct None {};
  /// With derivatives equal normals may turn apart, so that each cluster has a
  /// direction of its own; this is the same without derivatives, for sums that
  /// are the same to the last bit.
  [[no_unique_address]] std::conditional_t<std::is_same_v<T, double>, None,
                                           SkinCouplingOf<double>> values{};

  bool empty() const { return members.empty(); }
  void clear() {
    members.clear();
    directions.clear();
    together.clear();
    values = {};
  }

  /// H of two clusters.
  T operator()(std::size_t i, std::size_t j) const {
    if (empty()) return T(i == j ? 1.0 : 0.0);
    const Member &one = members[i], &other = members[j];
    const Direction& a = directions[one.direction];
    const Direction& b = directions[other.direction];
    if (a.first != b.first || a.slope == 0.0 || b.slope == 0.0) return T(0);
    const T part = one.slope / a.slope, other_part = other.slope / b.slope;
    T beside{0};
    if (one.direction == other.direction) beside -= part * other.slope;
    if (i == j) beside += one.slope;
    const T& N = together[a.row + (other.direction - a.first)];
    return part * N * other_part + beside;
  }
};

}  // namespace drake_haptics
