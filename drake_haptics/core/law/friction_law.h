#pragma once

#include "base/autodiff.h"
#include "base/types.h"
#include "law/friction_state.h"

namespace drake_haptics {

/// Parameters of stick-slip friction that all objects share.
struct FrictionParameters {
  double static_ratio = 1;  ///< static over sliding coefficient, at least 1
  double break_away = 0;    ///< displacement that a contact bears, m
  double reach = 0;         ///< how far a contact hands on its adhesion, m
};

/// The friction force of one contact and how it changes with displacement.
template <typename T>
struct FrictionForceOf {
  Vec3Of<T> f_W = Vec3Of<T>::Zero();  ///< on the tool, N
  Mat3Of<T> K_W = Mat3Of<T>::Zero();  ///< its stiffness, N/m, PSD
  bool sliding = false;
};

/// Stick-slip friction of a contact under the normal force N, after Hayward and
/// Armstrong (2000): the force −k z draws the tool back to the adhesion point,
/// from which it has moved by z. The adhesion point stays where it is while
/// |k z| is within the limit (α(z) = 0: the contact sticks, without creep) and
/// is drawn along beyond it (their bound of |z|: it slides). No time enters.
///
/// k = μ_s load / break_away, so that a contact breaks away after `break_away`.
/// The limit lies between μ_s N and μ N, by the grip. Slip wears the grip down
/// over the length `break_away`; relief of the force below μ N restores it, all
/// of it when the relief is half of (μ_s − μ) N. So what has stopped sticks
/// again, and the force is a Lipschitz function of displacement, always in the
/// cone.
///
/// The stiffness is that of the next tick, if the motion goes on: −df/dx where
/// the contact will stick, and where it will slide what turns the force with
/// the motion, and the secant up to the limit. So the implicit step of a tool
/// that comes down fast stays in the cone too.
/// @param normal_force N, above 0.
/// @param coefficient μ of sliding, above 0.
/// @param motion of the tool against the object since the last tick, m.
/// @param contact its displacement and grip are updated.
template <typename T>
FrictionForceOf<T> ApplyStickSlip(const T& normal_force, double coefficient,
                                  const FrictionParameters& parameters,
                                  const Eigen::Matrix<T, 3, 1>& motion,
                                  AdhesiveContactOf<T>* contact);

}  // namespace drake_haptics
