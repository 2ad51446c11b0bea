#pragma once

#include "base/autodiff.h"
#include "law/clustering.h"
#include "law/friction.h"
#include "law/penalty_force.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Value of the abstract ports of a haptic loop of scalar type AutoDiff: a set
/// with derivatives by `num_derivatives` variables.
template <typename Set>
struct Differentiated {
  Set set;
  Eigen::Index num_derivatives = 0;
};

using AutoDiffContactSet = Differentiated<ContactSetOf<AutoDiff>>;
using AutoDiffClusterSet = Differentiated<ClusterSetOf<AutoDiff>>;
using AutoDiffPenaltyWrench = Differentiated<PenaltyWrenchOf<AutoDiff>>;
using AutoDiffFrictionStep = Differentiated<FrictionStepOf<AutoDiff>>;

/// Returns the values without derivatives.
ContactSet ValuesOf(const ContactSetOf<AutoDiff>& set);
ClusterSet ValuesOf(const ClusterSetOf<AutoDiff>& set);
MovingFrame ValuesOf(const MovingFrameOf<AutoDiff>& frame);
PenaltyWrench ValuesOf(const PenaltyWrenchOf<AutoDiff>& wrench);
FrictionStep ValuesOf(const FrictionStepOf<AutoDiff>& step);

/// Replaces values by those computed with doubles, which differ only by the
/// order in which Eigen sums: later decisions are the same to the last bit.
/// Constants get zero derivatives, so that all numbers have equally many.
template <typename Set, typename Plain>
void SetValues(const Plain& values, Differentiated<Set>* differentiated);

/// Returns a set without derivatives as one with zero derivatives.
template <typename Set>
Differentiated<Set> WithVariables(const Differentiated<Set>& constant,
                                  Eigen::Index num_derivatives);

}  // namespace drake_haptics
