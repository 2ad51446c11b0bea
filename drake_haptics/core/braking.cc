#include "braking.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "require.h"

namespace drake_haptics {
namespace {

using Vec4 = Eigen::Vector4d;

// W = w², w zero at touch and at D, one half-way.
double Weight(const Contact& contact, const BrakingGains& gains) {
  const double s = contact.distance / gains.distance;
  const double w = s > 0 && s < 1 ? 4 * s * (1 - s) : 0;
  return w * w;
}

// m, a unit vector that tells opposite normals apart.
Vec4 Lift(const Vec3& n) {
  return std::numbers::sqrt2 / 2 * Vec4(1, n.x(), n.y(), n.z());
}

// The shares of contacts, from Σ W m mᵀ in its principal axes.
class Shares {
 public:
  explicit Shares(const Eigen::Matrix4d& sum) : axes_(sum) {}

  // That of a contact with weight W > 0.
  double operator()(const Vec3& n, double W) const {
    const Vec4 m = axes_.eigenvectors().transpose() * Lift(n);
    const Eigen::Array4d along = axes_.eigenvalues().array().max(0.0);
    return (1 + kRounding) * W *
           (m.array().square() / (along + kRounding * W)).sum();
  }

 private:
  static constexpr double kRounding = 0.1;  // ρ

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> axes_;
};

// Spatial velocity's part along n at a point p of a moving frame.
double SpeedAlong(const Vec3& n, const Vec3& p_WC, const MovingFrame& frame) {
  return n.dot(frame.V_WF.tail<3>() +
               frame.V_WF.head<3>().cross(p_WC - frame.p_WF));
}

}  // namespace

void RequirePossible(const BrakingGains& gains) {
  RequireNotNegative(gains.damping, "damping_Ns_per_m");
  RequirePositive(gains.distance, "distance_m");
}

WrenchModel ComputeBraking(const std::vector<Contact>& contacts,
                           const MovingFrame& tool,
                           const std::vector<MovingFrame>& objects,
                           const BrakingGains& gains) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const Contact& contact : contacts) {
    const double W = Weight(contact, gains);
    const Vec4 m = Lift(contact.nhat_BA_W);
    if (W > 0) sum.noalias() += W * m * m.transpose();
  }
  WrenchModel model;
  if (sum.trace() == 0) return model;
  const Shares shares(sum);
  for (const Contact& contact : contacts) {
    const double W = Weight(contact, gains);
    if (W == 0) continue;
    const Vec3& n = contact.nhat_BA_W;
    const double approach =
        SpeedAlong(n, contact.p_WC, objects.at(contact.object)) -
        SpeedAlong(n, contact.p_WC, tool);
    if (!(approach > 0)) continue;
    const double damping = gains.damping * std::sqrt(W) * shares(n, W);
    Vec6 G;
    G << (contact.p_WC - tool.p_WF).cross(n), n;
    model.F += damping * approach * G;
    model.B.noalias() += damping * G * G.transpose();
  }
  return model;
}

}  // namespace drake_haptics
