#pragma once

#include <array>

#include "base/types.h"
#include "convex/support.h"

namespace drake_haptics {

/// Up to four vertices of the Minkowski difference A ⊖ B as vertex pairs: the
/// part of a simplex that stays valid when the pose changes.
struct SimplexVertexPairs {
  std::array<MinkowskiVertex, 4> vertex_pairs;
  int size = 0;
};

/// Up to four vertices of A ⊖ B at a pose, with the weights of the point of
/// their hull that is closest to the origin.
struct Simplex : SimplexVertexPairs {
  std::array<Vec3, 4> points;       ///< a − b, m, in A's frame
  std::array<double, 4> weights{};  ///< barycentric, of the closest point
  Vec3 normal = Vec3::Zero();  ///< for a triangle: away from the origin, m²

  bool Contains(const MinkowskiVertex& vertex_pair) const {
    for (int i = 0; i < size; ++i) {
      if (vertex_pairs[i] == vertex_pair) return true;
    }
    return false;
  }
  void Add(const MinkowskiVertex& vertex_pair, const Vec3& point) {
    vertex_pairs[size] = vertex_pair;
    points[size] = point;
    weights[size] = 1.0;
    ++size;
  }
  Vec3 Closest() const {
    Vec3 sum = weights[0] * points[0];
    for (int i = 1; i < size; ++i) sum += weights[i] * points[i];
    return sum;
  }
};

/// Shrinks `simplex` to the smallest face that contains its closest point to
/// the origin and sets the weights. A result of size four contains the origin.
void ReduceToClosest(Simplex* simplex);

}  // namespace drake_haptics
