#pragma once

#include "base/rotation.h"
#include "base/types.h"

namespace drake_haptics {

/// Bounds of the passivity controller.
struct PassivityBounds {
  double period = 0;                  ///< the tick, s
  double max_damping = 0;             ///< N·s/m
  double max_rotational_damping = 0;  ///< N·m·s/rad
  double reserve = 0;                 ///< largest balance that is kept, J
};

/// @throws std::invalid_argument unless the period is above 0, the others are
///         at least 0, and all are finite.
void RequirePossible(const PassivityBounds& bounds);

/// Returns the work of a constant wrench on a handle that moves from one pose
/// to another, J: force times the displacement of Ho, plus torque times the
/// rotation vector. It is exact for the force, and for the torque if the axis
/// of rotation is constant.
/// @param F_H_W [torque; force] at Ho in the world.
template <typename T>
T HeldWrenchWork(const Eigen::Matrix<T, 6, 1>& F_H_W,
                 const Eigen::Matrix<T, 7, 1>& from_q_WH,
                 const Eigen::Matrix<T, 7, 1>& to_q_WH);

/// Returns the energy balance of a device's port after another tick, J: the
/// passivity observer (Hannaford and Ryu 2002) with the work of the held wrench
/// between the samples in place of force times velocity (Ryu, Kim and Hannaford
/// 2004). Below zero, the port has given out more energy than it received. The
/// balance is never above the reserve. Work that is not finite is not counted.
template <typename T>
T ObserveEnergy(const T& balance, const T& work_on_device,
                const PassivityBounds& bounds);

/// The passivity controller: adds to the desired wrench the damping that
/// dissipates the deficit of the balance in one tick at the handle's velocity.
/// Both dampings are the same share of their maxima. Without a deficit, or for
/// a handle at rest, it returns exactly the desired wrench. It never adds power
/// to the handle.
template <typename T>
Vec6Of<T> LimitEnergy(const Eigen::Matrix<T, 6, 1>& F_Ho_W_desired,
                      const T& balance, const Eigen::Matrix<T, 6, 1>& V_WH,
                      const PassivityBounds& bounds);

}  // namespace drake_haptics
