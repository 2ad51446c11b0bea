#pragma once

#include "polytope.h"
#include "types.h"

namespace drake_haptics {

/// How far a feature of a piece can carry a contact along a direction.
enum class SurfaceSupport {
  kVirtual = 0,   ///< not on the mesh (paper, 5.3.1)
  kOriginal = 1,  ///< on the mesh, but the mesh goes on beyond it there
  kSupported = 2  ///< on the mesh, and the mesh around it stays behind it
};

/// Tells whether the mesh, not only the piece, is locally supported by the
/// unit direction n (in the polytope's frame, pointing out of it) at the
/// feature. A contact between solids that is a local minimum of the distance
/// is supported on both sides; a contact at the seam of two pieces, where the
/// surface goes on, is not.
SurfaceSupport ClassifySupport(const Polytope& polytope, Feature feature,
                               const Vec3& n);

/// The smallest feature that holds the given vertices (one to four, repeats
/// allowed); of several facets the one that faces the direction n most.
Feature FeatureOfVertices(const Polytope& polytope, const int* vertices,
                          int count, const Vec3& n);

}  // namespace drake_haptics
