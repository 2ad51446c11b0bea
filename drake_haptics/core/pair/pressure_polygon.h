#pragma once

#include <optional>
#include <vector>

#include "base/types.h"
#include "convex/polygon_clip.h"

namespace drake_haptics {

/// Buffers, kept between ticks.
struct PatchWorkspace {
  /// Corners in the contact's plane (x, y, m) with the pressure there (z, m).
  std::vector<Vec3> polygon, clipped, overlap;
};

/// Clips the workspace's polygon.
template <typename Value>
void ClipPolygon(const Value& value, PatchWorkspace* workspace) {
  ClipPolygon(value, &workspace->polygon, &workspace->clipped);
}

/// Load on a feature: the center of the pressure and its integral.
struct Load {
  Vec3 center;
  double integral = 0;  ///< over the area, m³, or over the length, m²
};

/// Load of the linear pressure (z of the corners) over a polygon or a segment;
/// none if there is no pressure.
std::optional<Load> PressureLoad(const std::vector<Vec3>& corners);

}  // namespace drake_haptics
