#pragma once

#include <vector>

#include "law/penalty_force.h"
#include "law/wrench_model.h"
#include "pair/contact.h"

namespace drake_haptics {

/// Gains of the braking before surfaces touch.
struct BrakingGains {
  double damping = 0;   ///< b, N·s/m
  double distance = 0;  ///< D, where braking begins, m
};

/// @throws std::invalid_argument unless the damping is at least 0 and the
///         distance above 0, both finite.
void RequirePossible(const BrakingGains& gains);

/// Wrenches of the braking.
template <typename T>
struct BrakingWrenchOf {
  WrenchModelOf<T> tool;  ///< on the tool at To
  /// Reaction on each object, at its origin.
  std::vector<Vec6Of<T>> F_objects_W;
};

/// The tool's wrench model, then the objects' wrenches one after another.
template <typename T>
VectorOf<T> ToVector(const BrakingWrenchOf<T>& wrench);

/// Brakes the approach of surfaces that do not touch yet, as McNeely,
/// Puterbaugh and Troy (1999) do: at each contact with 0 < d < D whose surfaces
/// approach at speed v, a force b s w v pushes along the normal. The profile
/// w = 4 (d/D)(1 − d/D) makes the wrench continuous at both ends, and slows a
/// mass m in straight motion by 2 b D / (3 m), at any speed.
///
/// Shares s keep contacts with equal normals from adding up. With the weights
/// W = w² and m = [1; n]/√2, whose products are 1 for equal, 1/2 for
/// perpendicular and 0 for opposite normals,
///   s_i = (1 + ρ) W_i m_iᵀ (Σ_j W_j m_j m_jᵀ + ρ W_i I)⁻¹ m_i,  ρ = 0.1:
/// the leverage of a contact among all, regularized so that it is continuous.
/// It is 1 for a single contact and nearly 1 beside any number of contacts with
/// other normals; n contacts with equal normals have about 1/n each. The sum of
/// all s_i is at most 4 (1 + ρ), four being the rank, so that the damping along
/// any direction is at most 4.4 b, or 1.1 b if all normals are equal.
///
/// The model's damping B is positive semidefinite. Its stiffness is zero: the
/// change of w, s and the normals with the pose is left out, since it is
/// proportional to the speed and has no definite sign.
/// @param objects one frame for each object that the contacts name.
/// @throws std::out_of_range for a contact with an object that is not given.
template <typename T>
BrakingWrenchOf<T> ComputeBraking(const std::vector<ContactOf<T>>& contacts,
                                  const MovingFrameOf<T>& tool,
                                  const std::vector<MovingFrameOf<T>>& objects,
                                  const BrakingGains& gains);

}  // namespace drake_haptics
