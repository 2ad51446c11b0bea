#pragma once

#include <array>

#include "base/types.h"

namespace drake_haptics {

/// The point of a triangle that is nearest to another point.
struct NearestOnTriangle {
  Vec3 point = Vec3::Zero();
  FeatureKind kind = FeatureKind::kFacet;  ///< feature that contains the point
  int index = 0;  ///< corner, or edge from corner `index` to the next
};

/// A triangle without area counts as its edges.
NearestOnTriangle FindNearestOnTriangle(const std::array<Vec3, 3>& corners,
                                        const Vec3& p);

}  // namespace drake_haptics
