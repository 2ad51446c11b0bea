#pragma once

#include "base/types.h"

namespace drake_haptics {

/// The point of a triangle that is nearest to the origin.
struct TriangleNearest {
  Vec3 n =
      Vec3::Zero();     ///< unit, from the origin to that point; zero if there
  double distance = 0;  ///< m; above the true one by no more than round-off
};

/// Where the nearest point is inside the triangle, n is the normal of its plane
/// and the distance the least of n · corner. That is a bound whatever n is, so
/// it holds for slivers and next to the origin, where n is inaccurate.
TriangleNearest FindTriangleNearest(const Vec3& p, const Vec3& q,
                                    const Vec3& r);

}  // namespace drake_haptics
