#pragma once

#include <optional>
#include <vector>

#include "base/types.h"

namespace drake_haptics {

/// Buffers, kept between ticks.
struct PatchWorkspace {
  /// Corners in the contact's plane (x, y, m) with the pressure there (z, m).
  std::vector<Vec3> polygon, clipped, overlap;
};

/// Keeps the part of a convex polygon, or of a segment given as two corners,
/// where the linear function with the given corner values is not negative.
template <typename Value>
void ClipPolygon(const Value& value, PatchWorkspace* workspace) {
  const std::vector<Vec3>& polygon = workspace->polygon;
  std::vector<Vec3>& clipped = workspace->clipped;
  clipped.clear();
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = polygon[i];
    const double at_p = value(p);
    if (at_p >= 0) clipped.push_back(p);
    if (count == 2 && i == 1) break;  // A segment does not close.
    const Vec3& q = polygon[(i + 1) % count];
    const double at_q = value(q);
    if ((at_p < 0) != (at_q < 0) && at_p != at_q) {
      clipped.push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
  }
  workspace->polygon.swap(clipped);
}

/// What presses on a feature: the center of the pressure and its integral.
struct Load {
  Vec3 center;
  double integral = 0;  ///< over the area, m³, or over the length, m²
};

/// Of the linear pressure (z of the corners) over a polygon or a segment;
/// nothing where nothing presses.
std::optional<Load> PressureLoad(const std::vector<Vec3>& corners);

}  // namespace drake_haptics
