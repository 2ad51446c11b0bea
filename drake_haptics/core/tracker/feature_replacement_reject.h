#pragma once

#include "base/types.h"
#include "convex/support.h"
#include "pair/separation.h"

namespace drake_haptics {

/// Whether both surfaces may carry a contact, with a gap above `floor` (m),
/// between a facet of one body and the vertex of the other that faces it. False
/// proves that they do not, at less cost than finding the contact.
///
/// Virtual facets carry no contact, and the other body carries none along
/// directions outside its normal cone. The farthest vertex of the other body
/// below the facet's plane bounds the gap.
/// @param n the contact's normal at the facet, in A's frame.
/// @param facet its index; `is_of_A` says in which body.
/// @param near where the search for the farthest vertex starts.
bool MayReplaceFeature(const PosedPair& pair, const Vec3& n, int facet,
                       bool is_of_A, const MinkowskiVertex& near, double floor);

/// Whether an earlier corner of the simplex is on the same vertex of a body.
bool IsRepeated(const Simplex& simplex, int corner,
                int MinkowskiVertex::* side);

}  // namespace drake_haptics
