#pragma once

#include "base/types.h"
#include "convex/support.h"
#include "pair/separation.h"

namespace drake_haptics {

/// Whether the contact between a facet of one of two bodies and the vertex of
/// the other that faces it may be carried by both surfaces, with a gap above
/// `floor` (m): false is a proof that it is not, for less than finding it.
///
/// Virtual facets carry nothing, and the other body nothing along directions
/// outside its normal cone. The farthest vertex of the other body below the
/// facet's plane bounds the gap.
/// @param n the facet's normal as that of the contact, in A's frame.
/// @param facet its index; `is_of_A` tells of which body.
/// @param near where the search for the farthest vertex starts.
bool MayReplaceFeature(const PosedPair& pair, const Vec3& n, int facet,
                       bool is_of_A, const MinkowskiVertex& near, double floor);

/// Whether an earlier corner of the simplex is on the same vertex of a body.
bool IsRepeated(const Simplex& simplex, int corner,
                int MinkowskiVertex::* side);

}  // namespace drake_haptics
