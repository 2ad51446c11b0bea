#pragma once

#include <span>
#include <vector>

#include "mesh/patch_surroundings.h"

namespace drake_haptics {

/// The polytope of a patch, with the features that are on the mesh marked.
struct SurfacePiece {
  Polytope polytope;
  /// Triangles of the patch that are on no original facet, so that no contact
  /// would find them. Only noise can cause them.
  std::vector<int> lost;
};

/// @param patch triangles, ascending, one or more.
/// @param tolerance surface tolerance of the mesh, m.
SurfacePiece MakeSurfacePiece(std::span<const int> patch, double tolerance,
                              MeshTopology* mesh);

}  // namespace drake_haptics
