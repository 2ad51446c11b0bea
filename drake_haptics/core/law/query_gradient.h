#pragma once

#include <vector>

#include "base/autodiff.h"
#include "base/types.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"

namespace drake_haptics {

/// A body's pieces, and their pose as a function of the variables.
struct DisplacedShape {
  const Decomposition* shape = nullptr;
  PoseOf<AutoDiff> X_WB;
};

/// Returns a body whose pose vector [qw qx qy qz x y z] has derivatives. If q
/// is not unit, the rotation is that of q / |q|.
/// @throws std::invalid_argument unless it is a pose; `what` names it.
DisplacedShape DisplaceShape(const Decomposition* shape,
                             const AutoDiffVector& q_WB, const char* what);

/// Returns the contacts of a query with derivatives at constant features
/// (frozen_features.h).
///
/// The derivatives are exact except for the pressure patch of nearly flush
/// faces, a blend of clipped polygons: its center and extent are evaluated at
/// displacements of 1e-4 and 2e-4 of its layer to both sides, with a relative
/// error of about 1e-9.
/// @param contacts as the query gave them at these poses, not shaded.
/// @param tolerance of the query, m.
/// @throws std::invalid_argument, std::out_of_range where a contact names an
///         object, a piece or a feature that is not given.
ContactSetOf<AutoDiff> DifferentiateContacts(
    const ContactSet& contacts, double tolerance, const DisplacedShape& tool,
    const std::vector<DisplacedShape>& objects);

}  // namespace drake_haptics
