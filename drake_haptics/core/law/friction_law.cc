#include "law/friction_law.h"

#include <algorithm>

namespace drake_haptics {
namespace {

// Stiffness of the force −k z, at most `limit`, over the motion u ahead.
template <typename T>
Mat3Of<T> StiffnessAhead(const T& k, const T& limit, const Vec3Of<T>& z,
                         const Vec3Of<T>& n, const Vec3Of<T>& motion) {
  const Mat3Of<T> in_plane = Mat3Of<T>::Identity() - n * n.transpose();
  const Vec3Of<T> u = in_plane * motion;
  const Vec3Of<T> z_ahead = z + u;
  const T length = LengthOf(z_ahead);
  if (k * length <= limit) return k * in_plane;
  const Vec3Of<T> e = z_ahead / length;
  const T along = e.dot(u);
  const T secant =
      along > 0.0 ? std::clamp(T(T(limit - T(k * e.dot(z))) / along), T(0.0), k)
                  : T(0.0);
  const T turning = limit / length;
  return turning * in_plane + T(secant - turning) * e * e.transpose();
}

}  // namespace

template <typename T>
FrictionForceOf<T> ApplyStickSlip(const T& normal_force, double coefficient,
                                  const FrictionParameters& parameters,
                                  const Eigen::Matrix<T, 3, 1>& motion,
                                  AdhesiveContactOf<T>* contact) {
  const double static_coefficient = parameters.static_ratio * coefficient;
  const T k = static_coefficient * contact->load / parameters.break_away;
  const T sliding_limit = coefficient * normal_force;
  const T extra = (static_coefficient - coefficient) * normal_force;
  T limit = sliding_limit + T(contact->grip * extra);

  FrictionForceOf<T> force;
  const T length = LengthOf(contact->z_W);
  force.sliding = k * length > limit;
  if (force.sliding) {
    // The slip s at which k (|z| − s) meets a limit that falls with s. The
    // limit falls more slowly than the spring, since load >= N.
    const T wear = extra / parameters.break_away;
    T slip = T(T(k * length) - limit) / T(k - wear);
    contact->grip -= slip / parameters.break_away;
    if (contact->grip < 0.0) {
      slip = length - T(sliding_limit / k);
      contact->grip = T(0.0);
    }
    limit = sliding_limit + T(contact->grip * extra);
    contact->z_W *= T(T(length - slip) / length);
  }
  force.f_W = -k * contact->z_W;
  force.K_W =
      StiffnessAhead<T>(k, limit, contact->z_W, contact->nhat_BA_W, motion);
  const T relief = 2 * (sliding_limit - LengthOf(force.f_W));
  contact->grip =
      relief < extra ? std::max(contact->grip, T(relief / extra)) : T(1.0);
  return force;
}

template FrictionForceOf<double> ApplyStickSlip(const double&, double,
                                                const FrictionParameters&,
                                                const Vec3&,
                                                AdhesiveContactOf<double>*);
template FrictionForceOf<AutoDiff> ApplyStickSlip(const AutoDiff&, double,
                                                  const FrictionParameters&,
                                                  const Vec3Of<AutoDiff>&,
                                                  AdhesiveContactOf<AutoDiff>*);

}  // namespace drake_haptics
