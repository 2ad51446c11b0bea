#pragma once

#include "convex/support.h"
#include "pair/depth_certificate.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// Starts `surface` with a hull of vertex pairs that has the origin inside. The
/// hull grows from a facet of A ⊖ B and the vertex pair farthest behind it, by
/// the support along the normal of the face that the origin is farthest outside
/// of.
/// @param facet shallower facets may exist; the origin is below its plane.
/// @returns false where no such hull was found: A ⊖ B is flat or has the origin
///     on its boundary to round-off, or a bound was met.
bool GrowEnclosingPolytope(const PosedPair& pair, const DepthCandidate& facet,
                           DepthCertificate* surface);

/// A direction for WindingNumber: behind a facet, and askew so that it rarely
/// meets an edge.
Vec3 RayBehind(const DepthCandidate& facet);

}  // namespace drake_haptics
