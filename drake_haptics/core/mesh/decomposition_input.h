#pragma once

#include <span>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// @throws std::invalid_argument if there is no triangle, an index is out of
/// range or a coordinate is not finite and below 1e50 m.
void CheckMesh(std::span<const Vec3> vertices,
               std::span<const Triangle> triangles);

}  // namespace drake_haptics
