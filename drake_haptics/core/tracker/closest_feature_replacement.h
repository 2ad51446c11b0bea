#pragma once

#include "convex/support.h"
#include "pair/contact_patch.h"
#include "pair/local_penetration_walk.h"
#include "pair/separation.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// What becomes of closest points that the surfaces do not carry by themselves.
struct Promotion {
  DepthCandidate facet;  ///< takes their place; not kSupported if there is none
  MinkowskiVertex vertex_pair;  ///< of the facet
  /// Without a facet: they are a contact with A out of the walls that it
  /// presses into.
  bool is_beside_wall = false;
  /// Features that face each other end before a contact: more of
  /// SurfaceRequest::translation_vectors might find one.
  bool ends_early = false;
};

/// The closest points of the hulls are not closest points of the surfaces, as
/// at a hollow corner or a seam: the nearest facet beside them that faces a
/// vertex of the other body, if that vertex is over it (paper, 5.3.2), or its
/// face lies flush on it; else two edges beside them that cross.
///
/// In a hollow corner the vertex may be beyond the facet because A presses into
/// the next wall. Where it would be over the facet with A out of that wall, the
/// closest points count; so a wall is not lost where another one is touched.
/// @param surface_goes_on_flat the meshes beyond the pieces rise little.
Promotion PromoteClosestPoints(const PosedPair& pair,
                               const Separation& separation,
                               const SurfaceRequest& request,
                               bool surface_goes_on_flat,
                               PatchWorkspace* workspace);

}  // namespace drake_haptics
