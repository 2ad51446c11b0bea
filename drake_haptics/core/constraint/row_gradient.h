#pragma once

#include "base/autodiff.h"
#include "base/types.h"
#include "constraint/constraint_rows.h"
#include "law/query_gradient.h"

namespace drake_haptics {

/// A row with derivatives.
struct MovingRow {
  Vec6Of<AutoDiff> a;  ///< [r × n; n] about To, in W
  AutoDiff distance;   ///< m
  Vec3Of<AutoDiff> n, p_WCa, p_WCb;
};

/// How a row moves with its bodies while features stay (frozen_features.h): its
/// normal as that of the plane does, and each of its points along the vertex,
/// edge or facet that it lies on, so that they stay opposite each other. Where
/// both are inside of facets, they stay with A.
/// @param plane that the row is of.
/// @param tool, object posed where the row was found.
MovingRow DifferentiateRow(const ConstraintRow& row,
                           const SeparatingPlane& plane,
                           const DisplacedShape& tool,
                           const DisplacedShape& object);

/// The plane's contact in the world with derivatives, while features stay.
ContactOf<AutoDiff> DifferentiatePlane(const SeparatingPlane& plane,
                                       const DisplacedShape& tool,
                                       const DisplacedShape& object);

}  // namespace drake_haptics
