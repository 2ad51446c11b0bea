#pragma once

#include "convex/support.h"
#include "pair/local_penetration_walk.h"
#include "pair/separation.h"
#include "tracker/surface_request.h"

namespace drake_haptics {

/// Contact in place of closest points that the surfaces do not carry.
struct Promotion {
  DepthCandidate facet;  ///< replacement; not kSupported if there is none
  MinkowskiVertex vertex_pair;  ///< of the facet
  /// Without a facet: the closest points are a contact with A moved out of the
  /// walls that it presses into.
  bool is_beside_wall = false;
  /// Features that face each other end short of a contact: more
  /// SurfaceRequest::translation_vectors might give one.
  bool ends_early = false;
};

/// Replaces closest points of the hulls that are not closest points of the
/// surfaces, as at a concave corner or a seam: by the adjacent facet with the
/// largest gap that faces a vertex of the other body, if that vertex is over it
/// (paper, 5.3.2); else by two adjacent edges that cross.
///
/// In a concave corner the vertex may be beyond the facet because A presses
/// into the next wall. If it would be over the facet with A moved out of that
/// wall, the closest points count, so that touching one wall does not lose
/// another.
Promotion PromoteClosestPoints(const PosedPair& pair,
                               const Separation& separation,
                               const SurfaceRequest& request);

}  // namespace drake_haptics
