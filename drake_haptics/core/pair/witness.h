#pragma once

#include <span>

#include "base/types.h"
#include "convex/support.h"

namespace drake_haptics {

/// Witness points of a contact, in A's frame (m): p_a − p_b = h n.
struct Witness {
  Vec3 p_a;
  Vec3 p_b;
};

/// The witness points of a facet of A ⊖ B: the vertex of a vertex–facet pair
/// with its foot on the facet's plane, or the points where two crossing edges
/// pass each other.
Witness WitnessOfFeatures(const PosedPair& pair, Feature feature_A,
                          Feature feature_B, const Vec3& n, double h);

/// The point of A's edge nearest to B's edge, found from the point on A where
/// their lines pass each other. For nearly parallel edges that point is far
/// beyond both.
Vec3 OnCrossedEdges(const PosedPair& pair, Feature edge_A, Feature edge_B,
                    const Vec3& crossing);

/// How far (m) the witness lies outside its features, measured along the
/// contact's plane; zero where the contact is within both.
[[nodiscard]] double LateralOffset(const PosedPair& pair, Feature feature_A,
                                   Feature feature_B, const Witness& witness);

/// The same after A is moved out of the walls that stand upright on the
/// contact's plane, or lean over it.
/// @param n normal of the contact, unit, in A's frame.
/// @param translation_vectors translations of A out of one wall each, in its
/// frame, m.
[[nodiscard]] double LateralOffsetOutOfWalls(
    const PosedPair& pair, Feature feature_A, Feature feature_B, const Vec3& n,
    const Witness& witness, std::span<const Vec3> translation_vectors);

}  // namespace drake_haptics
