#include "passivity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "require.h"

namespace drake_haptics {

void RequirePossible(const PassivityBounds& bounds) {
  RequirePositive(bounds.period, "period_s");
  RequireNotNegative(bounds.max_damping, "max_damping_Ns_per_m");
  RequireNotNegative(bounds.max_rotational_damping,
                     "max_rotational_damping_Nms_per_rad");
  RequireNotNegative(bounds.reserve, "reserve_J");
}

double HeldWrenchWork(const Vec6& F_H_W, const PoseVector& from_q_WH,
                      const PoseVector& to_q_WH) {
  const Vec3 turn =
      RotationLog(QuaternionOf(to_q_WH) * QuaternionOf(from_q_WH).conjugate());
  return F_H_W.head<3>().dot(turn) +
         F_H_W.tail<3>().dot(to_q_WH.tail<3>() - from_q_WH.tail<3>());
}

double ObserveEnergy(double balance, double work_on_device,
                     const PassivityBounds& bounds) {
  if (!std::isfinite(work_on_device)) return balance;
  return std::min(balance - work_on_device, bounds.reserve);
}

Vec6 LimitEnergy(const Vec6& F_asked, double balance, const Vec6& V_WH,
                 const PassivityBounds& bounds) {
  if (!(balance < 0)) return F_asked;
  Vec6 braking;
  braking << bounds.max_rotational_damping * V_WH.head<3>(),
      bounds.max_damping * V_WH.tail<3>();
  // What the largest dampings would dissipate in a tick.
  const double largest = bounds.period * braking.dot(V_WH);
  if (!(largest > 0 && std::isfinite(largest))) return F_asked;
  return F_asked - std::min(1.0, -balance / largest) * braking;
}

}  // namespace drake_haptics
