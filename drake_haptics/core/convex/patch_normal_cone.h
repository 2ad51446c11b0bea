#pragma once

#include "base/direction_cone.h"
#include "convex/polytope.h"

namespace drake_haptics {

/// Sets the arc of each original edge along which it can be
/// NormalConeSupport::kSupported: between the normals of the mesh faces beside
/// it, and as far beyond them as the slack allows. The wings must be set.
void FillEdgeNormalArcs(Polytope* piece);

/// A cone that holds all outward directions along which a feature of the piece
/// can be NormalConeSupport::kSupported (surface_support.h); all directions
/// where they do not fit into one narrower than a right angle.
///
/// Along a facet that is its normal, along an edge its arc, which must be set,
/// and along a vertex the directions from which
/// all edges of the mesh fall away: a spherical polygon with a corner wherever
/// two of these edges allow no more.
DirectionCone FindPatchNormalCone(const Polytope& piece);

}  // namespace drake_haptics
