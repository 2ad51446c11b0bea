#include "friction_law.h"

#include <algorithm>

namespace drake_haptics {
namespace {

// How the force −k z, at most `limit`, will change over the motion u.
Mat3 StiffnessAhead(double k, double limit, const Vec3& z, const Vec3& n,
                    const Vec3& motion) {
  const Mat3 in_plane = Mat3::Identity() - n * n.transpose();
  const Vec3 u = in_plane * motion;
  const Vec3 z_ahead = z + u;
  const double length = z_ahead.norm();
  if (k * length <= limit) return k * in_plane;
  const Vec3 e = z_ahead / length;
  const double along = e.dot(u);
  const double secant =
      along > 0 ? std::clamp((limit - k * e.dot(z)) / along, 0.0, k) : 0.0;
  const double turning = limit / length;
  return turning * in_plane + (secant - turning) * e * e.transpose();
}

}  // namespace

FrictionForce ApplyStickSlip(double normal_force, double coefficient,
                             const FrictionParameters& parameters,
                             const Vec3& motion, AdhesiveContact* contact) {
  const double static_coefficient = parameters.static_ratio * coefficient;
  const double k = static_coefficient * contact->load / parameters.break_away;
  const double sliding_limit = coefficient * normal_force;
  const double extra = (static_coefficient - coefficient) * normal_force;
  double limit = sliding_limit + contact->grip * extra;

  FrictionForce force;
  const double length = contact->z_W.norm();
  force.sliding = k * length > limit;
  if (force.sliding) {
    // The slip s at which k (|z| − s) meets a limit that falls with s. The
    // limit falls more slowly than the spring, since load >= N.
    const double wear = extra / parameters.break_away;
    double slip = (k * length - limit) / (k - wear);
    contact->grip -= slip / parameters.break_away;
    if (contact->grip < 0) {
      slip = length - sliding_limit / k;
      contact->grip = 0;
    }
    limit = sliding_limit + contact->grip * extra;
    contact->z_W *= (length - slip) / length;
  }
  force.f_W = -k * contact->z_W;
  force.K_W =
      StiffnessAhead(k, limit, contact->z_W, contact->nhat_BA_W, motion);
  const double relief = 2 * (sliding_limit - force.f_W.norm());
  contact->grip =
      relief < extra ? std::max(contact->grip, relief / extra) : 1.0;
  return force;
}

}  // namespace drake_haptics
