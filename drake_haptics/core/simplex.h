#pragma once

#include <array>

#include "support.h"
#include "types.h"

namespace drake_haptics {

/// Up to four vertices of the Minkowski difference A ⊖ B, with the weights of
/// the point of their hull that is closest to the origin.
struct Simplex {
  std::array<Hub, 4> hubs;
  std::array<Vec3, 4> points;       ///< a − b, m, in A's frame
  std::array<double, 4> weights{};  ///< barycentric, of the closest point
  int size = 0;

  bool Contains(const Hub& hub) const;
  void Add(const Hub& hub, const Vec3& point);
  Vec3 Closest() const;
};

/// Shrinks `simplex` to the smallest face that holds its closest point to the
/// origin and sets the weights. A result of size four holds the origin.
void ReduceToClosest(Simplex* simplex);

}  // namespace drake_haptics
