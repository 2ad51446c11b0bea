#pragma once

#include <span>
#include <vector>

#include "base/direction_cone.h"
#include "convex/polytope.h"

namespace drake_haptics {

/// Sets the arc of directions along which each original edge can be
/// NormalConeSupport::kSupported: between the normals of the mesh faces beside
/// it, and as far beyond them as the slack allows. The wings must be set.
void FillEdgeNormalArcs(Polytope* piece);

/// Corners of the directions from which all edges of the mesh at a vertex fall
/// away: on each, two edges rise by the slack and no other by more.
/// @param ring unit directions from the vertex along these edges.
std::vector<Vec3> FindRingCorners(std::span<const Vec3> ring);

/// Cone of all outward directions along which a feature of the piece can be
/// NormalConeSupport::kSupported (normal_cone_support.h); all directions if
/// they do not fit into a cone narrower than a right angle.
///
/// For a facet this is its normal, for an edge its arc, which must be set, and
/// for a vertex the directions from which all edges of the mesh fall away: a
/// spherical polygon with a corner where two of these edges limit it.
/// @param ring_corners FindRingCorners for each vertex of the piece.
DirectionCone FindPatchNormalCone(
    const Polytope& piece, std::span<const std::span<const Vec3>> ring_corners);

}  // namespace drake_haptics
