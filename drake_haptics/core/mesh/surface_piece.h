#pragma once

#include <span>
#include <vector>

#include "mesh/patch_surroundings.h"

namespace drake_haptics {

/// The polytope of a patch, which knows what of it is mesh.
struct SurfacePiece {
  Polytope polytope;
  /// Triangles of the patch that no original facet stands for, so that no
  /// contact would find them. Only noise can cause them.
  std::vector<int> lost;
};

/// @param patch triangles, ascending, one or more.
/// @param tolerance surface tolerance of the mesh, m.
SurfacePiece MakeSurfacePiece(const MeshTopology& mesh,
                              std::span<const int> patch, double tolerance);

}  // namespace drake_haptics
