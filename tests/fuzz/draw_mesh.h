#pragma once

#include <cstdint>
#include <vector>

#include "byte_source.h"
#include "mesh/decomposition.h"

namespace drake_haptics::fuzz {

/// A triangle mesh as the decomposition takes it in.
struct DrawnMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> solid;
};

/// A mesh that the intake would pass or nearly so: boxes that are joined,
/// notched or bent, hulls of drawn points, sheets with and without holes.
DrawnMesh DrawMesh(ByteSource* source);

/// One solid: the hull of drawn points or a bent wall.
DrawnMesh DrawSolid(ByteSource* source);

/// The same with damage at times: corners moved onto each other, triangles
/// turned, doubled or taken away, indices and coordinates of any value.
DrawnMesh DrawDamagedMesh(ByteSource* source);

}  // namespace drake_haptics::fuzz
