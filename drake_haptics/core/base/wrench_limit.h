#pragma once

#include "base/types.h"

namespace drake_haptics {

/// How a wrench comes out of `LimitWrench`: kLimited where force or torque is
/// at its limit, be it that it was shortened here or before.
enum class WrenchFate { kAsAsked = 0, kLimited = 1, kNotFinite = 2 };

/// A wrench within a device's limits.
struct LimitedWrench {
  Vec6 F = Vec6::Zero();  ///< [torque (N·m); force (N)]
  WrenchFate fate = WrenchFate::kNotFinite;
};

/// Shortens force and torque, each by itself and along its own direction, to
/// what a device may show. A wrench that is not finite becomes none.
LimitedWrench LimitWrench(const Vec6& F, double max_torque, double max_force);

}  // namespace drake_haptics
