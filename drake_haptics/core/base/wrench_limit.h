#pragma once

#include "base/types.h"

namespace drake_haptics {

/// Outcome of `LimitWrench`: kLimited if force or torque is at its limit,
/// whether it was shortened here or before.
enum class WrenchFate { kAsAsked = 0, kLimited = 1, kNotFinite = 2 };

/// A wrench within a device's limits.
struct LimitedWrench {
  Vec6 F = Vec6::Zero();  ///< [torque (N·m); force (N)]
  WrenchFate fate = WrenchFate::kNotFinite;
};

/// Shortens force (N) and torque (N·m) separately, each along its own
/// direction, to a device's limits. A wrench that is not finite becomes zero.
LimitedWrench LimitWrench(const Vec6& F, double max_torque, double max_force);

}  // namespace drake_haptics
