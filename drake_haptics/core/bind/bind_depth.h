#pragma once

#include <nanobind/nanobind.h>

namespace drake_haptics {

/// Reads a depth by its name: false for 'tracked', true for 'global'.
/// @throws std::invalid_argument for anything else.
bool IsGlobalDepth(nanobind::handle depth);

/// The name of a depth.
inline const char* DepthName(bool is_global) {
  return is_global ? "global" : "tracked";
}

}  // namespace drake_haptics
