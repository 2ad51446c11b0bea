#pragma once

#include "base/autodiff.h"
#include "base/types.h"
#include "law/friction_state.h"

namespace drake_haptics {

/// Parameters of stick-slip friction that all objects share.
struct FrictionParameters {
  double static_ratio = 1;  ///< static over sliding coefficient, at least 1
  double break_away = 0;    ///< displacement before a contact slips, m
  double reach = 0;         ///< distance over which adhesion is handed on, m
};

/// Friction force of one contact and its stiffness.
template <typename T>
struct FrictionForceOf {
  Vec3Of<T> f_W = Vec3Of<T>::Zero();  ///< on the tool, N
  Mat3Of<T> K_W = Mat3Of<T>::Zero();  ///< its stiffness, N/m, PSD
  bool sliding = false;
};

/// Stick-slip friction of a contact under the normal force N, after Hayward and
/// Armstrong (2000): the force −k z pulls the tool back to the adhesion point,
/// from which it has moved by z. The adhesion point stays while |k z| is within
/// the limit (α(z) = 0: the contact sticks, without creep) and is dragged along
/// beyond it (their bound of |z|: it slides). The law is independent of time.
///
/// k = μ_s load / break_away, so that a contact breaks away after `break_away`.
/// The grip sets the limit between μ N and μ_s N. Slip over the length
/// `break_away` wears the grip down; a force below μ N restores it, fully when
/// it is less by half of (μ_s − μ) N. So a contact that has stopped sticks
/// again, and the force is a Lipschitz function of displacement, always in the
/// friction cone.
///
/// The stiffness is that of the next tick, if the motion continues: −df/dx if
/// the contact will stick; if it will slide, the turning of the force with the
/// motion and the secant up to the limit. So the implicit step of a tool that
/// lands fast stays in the cone, too.
/// @param normal_force N, above 0.
/// @param coefficient μ for sliding, above 0.
/// @param motion of the tool against the object since the last tick, m.
/// @param contact its displacement and grip are updated.
template <typename T>
FrictionForceOf<T> ApplyStickSlip(const T& normal_force, double coefficient,
                                  const FrictionParameters& parameters,
                                  const Eigen::Matrix<T, 3, 1>& motion,
                                  AdhesiveContactOf<T>* contact);

}  // namespace drake_haptics
