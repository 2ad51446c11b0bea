#pragma once

#include "base/types.h"

namespace drake_haptics {

/// The point of a triangle that is nearest to the origin.
struct TriangleNearest {
  Vec3 n = Vec3::Zero();  ///< unit, toward the point; zero if at the origin
  double distance = 0;    ///< m; above the true one by at most round-off
};

/// If the nearest point is inside the triangle, n is the normal of its plane
/// and the distance is the least n · corner. This is a lower bound for any n,
/// so it holds for slivers and next to the origin, where n is inaccurate.
TriangleNearest FindTriangleNearest(const Vec3& p, const Vec3& q,
                                    const Vec3& r);

}  // namespace drake_haptics
