#pragma once

#include "base/rotation.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// Slopes of the wrench on the handle by the handle's motion.
struct HandleSlopes {
  Mat6 K = Mat6::Zero();  ///< stiffness at Ho in W
  Mat6 B = Mat6::Zero();  ///< damping
};

/// K, then B, by rows.
Eigen::Matrix<double, 72, 1> ToVector(const HandleSlopes& slopes);

/// Returns the slopes of the wrench on a handle that holds a tool by a
/// coupling, with the tool in equilibrium between coupling and contact: springs
/// in series. With the coupling's Kc and the contact's Kt on the tool, the tool
/// follows the handle by G = (Kc + Kt)⁻¹ Kc, and the handle feels
///
///     K = Kc − Kc G,   B = (I − G)ᵀ Bc (I − G) + Gᵀ Bt G,
///
/// the static condensation of Guyan, AIAA Journal 3(2), 1965. In free space
/// both are zero; at a rigid wall they are the coupling's along the normal.
/// Both are symmetric and passive, because Kc, Bc, Kt and Bt are projected
/// first (`ProjectToPositiveSemidefinite`).
/// @param p_HoTo_W vector from the handle's origin to the tool's, m.
/// @param coupling the coupling's wrench on the tool, at To in W.
/// @param contact the sum of all other wrenches on the tool, at To in W.
HandleSlopes ComputeHandleSlopes(const Vec3& p_HoTo_W,
                                 const WrenchModel& coupling,
                                 const WrenchModel& contact);

}  // namespace drake_haptics
