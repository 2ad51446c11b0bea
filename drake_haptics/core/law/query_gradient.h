#pragma once

#include <vector>

#include "base/autodiff.h"
#include "base/types.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"

namespace drake_haptics {

/// A body's pieces, and where they are by the variables.
struct DisplacedShape {
  const Decomposition* shape = nullptr;
  PoseOf<AutoDiff> X_WB;
};

/// A body whose pose vector [qw qx qy qz x y z] has derivatives. With q not
/// unit, its rotation is that of q / |q|.
/// @throws std::invalid_argument unless it is a pose; `what` names it.
DisplacedShape DisplaceShape(const Decomposition* shape,
                             const AutoDiffVector& q_WB, const char* what);

/// The answer of a query with derivatives, while features stay
/// (frozen_features.h).
///
/// Exact but for the pressure patch of faces that lie nearly flush, a blend of
/// clipped polygons: its center and extent are evaluated at displacements of
/// 1e-4 and 2e-4 of its layer to both sides, with a relative error of about
/// 1e-9.
/// @param contacts as the query gave them at these poses, not shaded.
/// @param tolerance of the query, m.
/// @throws std::invalid_argument, std::out_of_range where a contact names an
///         object, a piece or a feature that is not given.
ContactSetOf<AutoDiff> DifferentiateContacts(
    const ContactSet& contacts, double tolerance, const DisplacedShape& tool,
    const std::vector<DisplacedShape>& objects);

}  // namespace drake_haptics
