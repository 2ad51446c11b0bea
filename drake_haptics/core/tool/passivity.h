#pragma once

#include "base/rotation.h"
#include "base/types.h"

namespace drake_haptics {

/// Bounds of the passivity controller.
struct PassivityBounds {
  double period = 0;                  ///< the tick, s
  double max_damping = 0;             ///< N·s/m
  double max_rotational_damping = 0;  ///< N·m·s/rad
  double reserve = 0;                 ///< largest balance kept, J
};

/// @throws std::invalid_argument unless the period is above 0, the others are
/// at
///         least 0, and all finite.
void RequirePossible(const PassivityBounds& bounds);

/// Work of a wrench on a handle that was held while the handle moved from one
/// pose to another, J: force times the way of Ho, torque times the rotation
/// vector. Exact for the force, and for the torque where the axis of rotation
/// stood still.
/// @param F_H_W [torque; force] at Ho in the world.
template <typename T>
T HeldWrenchWork(const Eigen::Matrix<T, 6, 1>& F_H_W,
                 const Eigen::Matrix<T, 7, 1>& from_q_WH,
                 const Eigen::Matrix<T, 7, 1>& to_q_WH);

/// The balance of the energy that a device's port has received after another
/// tick, J: the passivity observer (Hannaford and Ryu 2002) with the work of
/// the held wrench between the samples in place of force times velocity (Ryu,
/// Kim and Hannaford 2004). Below zero, the port has given out more than it
/// got. Never above the reserve. Work that is not finite is not counted.
template <typename T>
T ObserveEnergy(const T& balance, const T& work_on_device,
                const PassivityBounds& bounds);

/// The passivity controller: adds to the wrench asked for the damping that
/// dissipates in one tick, at the twist of the handle, what the balance lacks.
/// Both dampings are the same share of their largest ones. Returns exactly
/// what was asked where nothing lacks or the handle stands still. It never
/// adds power to the handle.
template <typename T>
Vec6Of<T> LimitEnergy(const Eigen::Matrix<T, 6, 1>& F_Ho_W_desired,
                      const T& balance, const Eigen::Matrix<T, 6, 1>& V_WH,
                      const PassivityBounds& bounds);

}  // namespace drake_haptics
