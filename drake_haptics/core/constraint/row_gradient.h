#pragma once

#include "base/rotation.h"
#include "constraint/constraint_rows.h"
#include "law/query_gradient.h"

namespace drake_haptics {

/// Contact of two pieces with derivatives, for fixed features
/// (frozen_features.h).
/// @param contact contact in the tool's frame, at the poses of tool and object.
ContactOf<AutoDiff> DifferentiatePieces(const PairContact& contact,
                                        const PiecePair& pieces,
                                        const DisplacedShape& tool,
                                        const DisplacedShape& object);

/// A row with derivatives.
struct MovingRow {
  Vec6Of<AutoDiff> a;  ///< [r × n; n] about To, in W
  AutoDiff distance;   ///< m
  Vec3Of<AutoDiff> n, p_WCa, p_WCb;
};

/// Differentiates a row by the motion of its bodies: each of its points moves
/// along the vertex, edge or facet that it lies on, so that the points stay
/// opposite each other. If both are inside facets, they stay with A.
/// @param n normal of the row's plane.
/// @param tool, object bodies at the poses at which the row was found.
MovingRow DifferentiateRow(const ConstraintRow& row, const PiecePair& pieces,
                           const Vec3Of<AutoDiff>& n,
                           const DisplacedShape& tool,
                           const DisplacedShape& object);

}  // namespace drake_haptics
