#pragma once

#include "convex/support.h"
#include "pair/contact_patch.h"
#include "pair/local_penetration_walk.h"
#include "pair/pair_contact.h"

namespace drake_haptics {

/// A vertex pair of a facet of A ⊖ B: the first vertices of its features.
MinkowskiVertex VertexPairOf(const PosedPair& pair,
                             const DepthCandidate& facet);

/// Patch of a contact between pieces of surfaces, for a layer as thick as
/// `tolerance` − h (m), at most PressureLayer(tolerance).
PressurePatch FindSurfacePatch(const PosedPair& pair, const Vec3& n, double h,
                               const MinkowskiVertex& vertex_pair,
                               const Vec3& p_a, double tolerance,
                               PatchWorkspace* workspace,
                               FacetEnd end = FacetEnd::kConvexAndFlushSides);

/// Moves a contact's witness points to the center of its patch.
/// @param vertex_pair supports the pair along the contact's normal.
void SpreadOver(const PressurePatch& patch, const MinkowskiVertex& vertex_pair,
                PairContact* contact);

/// Whether a contact lies no farther beyond its features' sides than a small
/// share of the size.
bool IsWithinSides(const PosedPair& pair, const PairContact& contact);

/// Whether the bodies press on the facet's own features; beyond them its plane
/// means nothing.
bool IsWithinFeatures(const PosedPair& pair, const DepthCandidate& facet,
                      double tolerance, PatchWorkspace* workspace);

}  // namespace drake_haptics
