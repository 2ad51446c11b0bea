#pragma once

#include "convex/support.h"
#include "pair/depth_certificate.h"
#include "pair/local_penetration_walk.h"

namespace drake_haptics {

/// Starts `surface` with a hull of vertex pairs that contains the origin. The
/// hull grows from a facet of A ⊖ B and the vertex pair farthest behind it.
/// Each step adds the support along the normal of the face that the origin is
/// farthest outside of.
/// @param facet facet with the origin below its plane; shallower ones may
///     exist.
/// @returns false if no such hull was found: A ⊖ B is flat or has the origin on
///     its boundary to round-off, or a bound was met.
bool GrowEnclosingPolytope(const PosedPair& pair, const DepthCandidate& facet,
                           DepthCertificate* surface);

/// Ray for WindingNumber: behind a facet, and askew so that it rarely meets an
/// edge.
Vec3 RayBehind(const DepthCandidate& facet);

}  // namespace drake_haptics
