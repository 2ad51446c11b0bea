#pragma once

#include <vector>

#include "mesh/decomposition.h"
#include "mesh/surface_mesh.h"

namespace drake_haptics {

/// Divides a surface into convex patches. Returns the patch of each triangle.
/// Patches grow breadth first over the dual graph from the largest free
/// triangle; a component that is convex as a whole is one patch.
/// @throws std::runtime_error when `progress` asked to stop.
std::vector<int> GrowPatches(const SurfaceMesh& mesh, const Progress& progress);

}  // namespace drake_haptics
