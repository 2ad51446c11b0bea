#pragma once

#include "base/autodiff.h"
#include "law/clustering.h"
#include "law/friction.h"
#include "law/penalty_force.h"
#include "pair/contact.h"

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
using AutoDiffFrictionStep = Differentiated<FrictionStepOf<AutoDiff>>;

/// The values alone.
ContactSet ValuesOf(const ContactSetOf<AutoDiff>& set);
ClusterSet ValuesOf(const ClusterSetOf<AutoDiff>& set);
MovingFrame ValuesOf(const MovingFrameOf<AutoDiff>& frame);
PenaltyWrench ValuesOf(const PenaltyWrenchOf<AutoDiff>& wrench);
FrictionStep ValuesOf(const FrictionStepOf<AutoDiff>& step);

/// Replaces values by those of doubles, which are the same but for the order
/// in which Eigen sums: what is decided further on is the same to the last bit.
/// Constants get derivatives that are zero, so that all numbers have as many.
template <typename Set, typename Plain>
void SetValues(const Plain& values, Differentiated<Set>* differentiated);

/// A set without derivatives as one with derivatives that are zero.
template <typename Set>
Differentiated<Set> WithVariables(const Differentiated<Set>& constant,
                                  Eigen::Index num_derivatives);

}  // namespace drake_haptics
