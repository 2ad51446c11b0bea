#pragma once

#include "base/rotation.h"
#include "base/types.h"

namespace drake_haptics {

/// The weight of the tool, a force at its center of mass, as the wrench
/// [torque; force] on the tool at To in W: [R_WT p_TTcm × m g; m g].
/// @param q_WT pose of the tool.
/// @param p_TTcm center of mass in the tool's frame, m.
/// @param weight_W m g, N.
template <typename T>
Vec6Of<T> ToolWeight(const Eigen::Matrix<T, 7, 1>& q_WT, const Vec3& p_TTcm,
                     const Vec3& weight_W);

}  // namespace drake_haptics
