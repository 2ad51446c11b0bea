#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// The convex polygon about points near a plane, seen along its normal.
struct FlatHull {
  Vec3 normal = Vec3::Zero();
  std::vector<Vec3> corners;  ///< counter-clockwise about the normal
  double area = 0, perimeter = 0;

  /// Whether a point near the plane is beyond no edge by more than `tolerance`.
  bool Contains(const Vec3& point, double tolerance) const;

  /// Whether parts of this total area fill it but for slivers of width
  /// `tolerance`.
  bool IsFilledBy(double part_area, double tolerance) const;
};

/// @param points one or more.
/// @param normal unit.
FlatHull FindFlatHull(std::span<const Vec3> points, const Vec3& normal);

}  // namespace drake_haptics
