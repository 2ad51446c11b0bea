#pragma once

#include "autodiff.h"
#include "clustering.h"
#include "contact.h"
#include "penalty_force.h"

namespace drake_haptics {

/// What crosses the abstract ports of a haptic loop of scalar type AutoDiff:
/// a value with derivatives by `num_derivatives` variables.
template <typename Set>
struct Differentiated {
  Set set;
  Eigen::Index num_derivatives = 0;
};

using AutoDiffContactSet = Differentiated<ContactSetOf<AutoDiff>>;
using AutoDiffClusterSet = Differentiated<ClusterSetOf<AutoDiff>>;
using AutoDiffPenaltyWrench = Differentiated<PenaltyWrenchOf<AutoDiff>>;

}  // namespace drake_haptics
