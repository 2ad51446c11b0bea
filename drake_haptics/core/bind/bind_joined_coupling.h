#pragma once

#include "base/rotation.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

/// Poses and velocities of handle and tool, and the gains of the coupling, as
/// a multiplexer joins them: [q_WH; V_WH; q_WT; V_WT; gains].
template <typename T>
using JoinedVector = Eigen::Matrix<T, 32, 1>;

/// Returns the coupling's wrenches at joined motions.
/// @throws std::invalid_argument for a gain that is out of range.
CouplingWrench ComputeJoinedCoupling(const JoinedVector<double>& joined,
                                     const PoseVector& q_HT);

}  // namespace drake_haptics
