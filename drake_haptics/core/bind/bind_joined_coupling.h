#pragma once

#include "base/rotation.h"
#include "tool/virtual_coupling.h"

namespace drake_haptics {

/// Poses and velocities of handle and tool, and the gains of the coupling, as
/// a multiplexer joins them: [q_WH; V_WH; q_WT; V_WT; gains; q_HT], q_HT being
/// the pose of the tool in the handle at which the spring rests.
template <typename T>
using JoinedVector = Eigen::Matrix<T, 39, 1>;

/// Returns the coupling's wrenches at joined motions.
/// @throws std::invalid_argument for a gain that is out of range.
CouplingWrench ComputeJoinedCoupling(const JoinedVector<double>& joined);

}  // namespace drake_haptics
