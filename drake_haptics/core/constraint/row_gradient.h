#pragma once

#include "base/autodiff.h"
#include "base/types.h"
#include "constraint/constraint_rows.h"
#include "law/query_gradient.h"

namespace drake_haptics {

/// The pose itself.
Pose ValuesOf(const PoseOf<AutoDiff>& X);

/// The contact of two pieces with derivatives, while features stay
/// (frozen_features.h).
/// @param contact in the tool's frame, where tool and object are posed.
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

/// How a row moves with its bodies: each of its points along the vertex, edge
/// or facet that it lies on, so that they stay opposite each other. Where both
/// are inside of facets, they stay with A.
/// @param n normal of its plane.
/// @param tool, object posed where the row was found.
MovingRow DifferentiateRow(const ConstraintRow& row, const PiecePair& pieces,
                           const Vec3Of<AutoDiff>& n,
                           const DisplacedShape& tool,
                           const DisplacedShape& object);

}  // namespace drake_haptics
