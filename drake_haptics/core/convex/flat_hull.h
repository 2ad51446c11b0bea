#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Convex hull of points near a plane, seen along its normal.
struct FlatHull {
  Vec3 normal = Vec3::Zero();
  std::vector<Vec3> corners;  ///< counter-clockwise about the normal
  double area = 0, perimeter = 0;

  /// Whether a point near the plane is at most `tolerance` (m) beyond any edge.
  bool Contains(const Vec3& point, double tolerance) const;

  /// Whether parts of this total area fill the polygon except for slivers of
  /// width `tolerance`, m.
  bool IsFilledBy(double part_area, double tolerance) const;
};

/// @param points one or more.
/// @param normal unit.
FlatHull FindFlatHull(std::span<const Vec3> points, const Vec3& normal);

}  // namespace drake_haptics
