#pragma once

#include <vector>

#include "base/autodiff.h"
#include "base/rotation.h"
#include "base/types.h"
#include "mesh/decomposition.h"
#include "pair/contact.h"

namespace drake_haptics {

/// A body's pieces, where they are, and how the body is displaced by D
/// variables: [rotation vector (rad); translation (m)] about its origin in the
/// world, (6, D).
struct DisplacedShape {
  const Decomposition* shape = nullptr;
  Pose X_WB;
  Eigen::Matrix<double, 6, Eigen::Dynamic> displacement;
};

/// A body whose pose vector [qw qx qy qz x y z] has derivatives. A quaternion
/// changes by half its rotation: with q not unit, by that of q / |q|.
/// @throws std::invalid_argument unless it is a pose; `what` names it.
DisplacedShape DisplaceShape(const Decomposition* shape,
                             const AutoDiffVector& q_WB, const char* what);

/// The answer of a query with derivatives: while features stay, a contact moves
/// with the object's body, and against it as FindContactGradient says.
/// @param contacts as the query gave them at these poses, not shaded.
/// @param tolerance of the query, m.
/// @throws std::invalid_argument, std::out_of_range where a contact names an
///         object, a piece or a feature that is not given.
ContactSetOf<AutoDiff> DifferentiateContacts(
    const ContactSet& contacts, double tolerance, const DisplacedShape& tool,
    const std::vector<DisplacedShape>& objects);

}  // namespace drake_haptics
