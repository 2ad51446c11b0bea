#include "tool/passivity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/require.h"

namespace drake_haptics {

void RequirePossible(const PassivityBounds& bounds) {
  RequirePositive(bounds.period, "period_s");
  RequireNotNegative(bounds.max_damping, "max_damping_Ns_per_m");
  RequireNotNegative(bounds.max_rotational_damping,
                     "max_rotational_damping_Nms_per_rad");
  RequireNotNegative(bounds.reserve, "reserve_J");
}

template <typename T>
T HeldWrenchWork(const Eigen::Matrix<T, 6, 1>& F_H_W,
                 const Eigen::Matrix<T, 7, 1>& from_q_WH,
                 const Eigen::Matrix<T, 7, 1>& to_q_WH) {
  const Vec6Of<T> motion = Displacement(from_q_WH, to_q_WH);
  return F_H_W.template head<3>().dot(motion.template head<3>()) +
         F_H_W.template tail<3>().dot(motion.template tail<3>());
}

template <typename T>
T ObserveEnergy(const T& balance, const T& work_on_device,
                const PassivityBounds& bounds) {
  if (!std::isfinite(ValueOf(work_on_device))) return balance;
  return std::min(T(balance - work_on_device), T(bounds.reserve));
}

template <typename T>
Vec6Of<T> LimitEnergy(const Eigen::Matrix<T, 6, 1>& F_Ho_W_desired,
                      const T& balance, const Eigen::Matrix<T, 6, 1>& V_WH,
                      const PassivityBounds& bounds) {
  if (!(ValueOf(balance) < 0)) return F_Ho_W_desired;
  Vec6Of<T> braking;
  braking << bounds.max_rotational_damping * V_WH.template head<3>(),
      bounds.max_damping * V_WH.template tail<3>();
  // Energy that the largest dampings would dissipate in a tick.
  const T largest = bounds.period * braking.dot(V_WH);
  if (!(ValueOf(largest) > 0 && std::isfinite(ValueOf(largest)))) {
    return F_Ho_W_desired;
  }
  const T share = std::min(T(1.0), T(T(-balance) / largest));
  return F_Ho_W_desired - share * braking;
}

template double HeldWrenchWork(const Vec6&, const PoseVector&,
                               const PoseVector&);
template AutoDiff HeldWrenchWork(const Vec6Of<AutoDiff>&,
                                 const PoseVectorOf<AutoDiff>&,
                                 const PoseVectorOf<AutoDiff>&);
template double ObserveEnergy(const double&, const double&,
                              const PassivityBounds&);
template AutoDiff ObserveEnergy(const AutoDiff&, const AutoDiff&,
                                const PassivityBounds&);
template Vec6 LimitEnergy(const Vec6&, const double&, const Vec6&,
                          const PassivityBounds&);
template Vec6Of<AutoDiff> LimitEnergy(const Vec6Of<AutoDiff>&, const AutoDiff&,
                                      const Vec6Of<AutoDiff>&,
                                      const PassivityBounds&);

}  // namespace drake_haptics
