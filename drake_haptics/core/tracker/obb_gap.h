#pragma once

#include "base/types.h"

namespace drake_haptics {

/// A box along the axes of its body's frame.
struct Box {
  Vec3 center = Vec3::Zero();  ///< m
  Vec3 half = Vec3::Zero();    ///< half extents, m
};

/// Gaps between boxes of a body A and boxes of a body B at one pose.
class ObbGap {
 public:
  explicit ObbGap(const Pose& X_AB);

  /// The largest gap along the six face normals of the two boxes (m), a lower
  /// bound of their distance; negative where none separates them.
  double Gap(const Box& a, const Box& b) const;

 private:
  Pose X_AB_;
  Mat3 reach_AB_;
};

}  // namespace drake_haptics
