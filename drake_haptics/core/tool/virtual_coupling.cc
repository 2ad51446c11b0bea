#include "tool/virtual_coupling.h"

#include <Eigen/Geometry>

namespace drake_haptics {
namespace {

// Shortens v to a limit if it is longer by more than rounding, as a yielding
// spring with its damper at rest is not. Then writes the slope of the shortened
// v and returns true.
template <typename T>
bool Shorten(double limit, Vec3Of<T>* v, Mat3Of<T>* slope) {
  constexpr double kRounding = 1e-14;
  if (!(ValueOf(v->squaredNorm()) > (1 + kRounding) * limit * limit)) {
    return false;
  }
  const T length = LengthOf(*v);
  const Vec3Of<T> along = *v / length;
  *v = limit * along;
  *slope =
      (limit / length) * (Mat3Of<T>::Identity() - along * along.transpose());
  return true;
}

// Load of a spring and a damper with equal gains in all directions, and its
// stiffness and damping.
template <typename T>
struct Pull {
  Vec3Of<T> load;
  Mat3Of<T> K, B;

  Pull(double stiffness, double damping, double limit, const Vec3Of<T>& stretch,
       const Vec3Of<T>& speed)
      : load(stretch),
        K(Vec3Of<T>::Constant(stiffness).asDiagonal()),
        B(Vec3Of<T>::Constant(damping).asDiagonal()) {
    Mat3Of<T> slope;
    // Shortens the stretch, since the load of a stiff spring may be infinite.
    if (Shorten(limit / stiffness, &load, &slope)) K = slope * stiffness;
    load *= stiffness;
    load += damping * speed;
    if (Shorten(limit, &load, &slope)) {
      K = slope * K.eval();
      B = slope * damping;
    }
  }
};

// Energy of a spring that yields at a limit, J.
template <typename T>
T YieldingEnergy(double stiffness, double limit, const Vec3Of<T>& stretch) {
  const T square = stretch.squaredNorm();
  const double reach = limit / stiffness;
  if (!(ValueOf(square) > reach * reach)) return 0.5 * stiffness * square;
  return limit * (LengthOf(stretch) - 0.5 * reach);
}

}  // namespace

template <typename T>
Vec6Of<T> CouplingStretchOf<T>::Load(const CouplingGains& gains) const {
  const Vec3Of<T> still = Vec3Of<T>::Zero();
  Vec6Of<T> load;
  load << Pull<T>(gains.rotational_stiffness, 0, gains.max_torque, twist, still)
              .load,
      Pull<T>(gains.stiffness, 0, gains.max_force, stretch, still).load;
  return load;
}

template <typename T>
T CouplingStretchOf<T>::Energy(const CouplingGains& gains) const {
  return YieldingEnergy(gains.stiffness, gains.max_force, stretch) +
         YieldingEnergy(gains.rotational_stiffness, gains.max_torque, twist);
}

template <typename T>
CouplingStretchOf<T> ComputeStretch(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT) {
  const Eigen::Quaternion<T> R_WH = QuaternionOf(q_WH);
  const Eigen::Quaternion<T> R_held =
      R_WH * QuaternionOf(q_HT).template cast<T>();
  const Vec3Of<T> p_HT_W = R_WH * q_HT.tail<3>().template cast<T>();
  return {p_HT_W, RotationLog<T>(R_held * QuaternionOf(q_WT).conjugate()),
          q_WH.template tail<3>() + p_HT_W - q_WT.template tail<3>()};
}

template <typename T>
CouplingWrenchOf<T> ComputeCoupling(const Eigen::Matrix<T, 7, 1>& q_WH,
                                    const Eigen::Matrix<T, 6, 1>& V_WH,
                                    const PoseVector& q_HT,
                                    const Eigen::Matrix<T, 7, 1>& q_WT,
                                    const Eigen::Matrix<T, 6, 1>& V_WT,
                                    const CouplingGains& gains) {
  const auto [p_HT_W, twist, stretch] = ComputeStretch<T>(q_WH, q_HT, q_WT);
  const Vec3Of<T> w_WH = V_WH.template head<3>();
  const Vec3Of<T> v_held = V_WH.template tail<3>() + w_WH.cross(p_HT_W);
  const Pull<T> force(gains.stiffness, gains.damping, gains.max_force, stretch,
                      v_held - V_WT.template tail<3>());
  const Pull<T> torque(gains.rotational_stiffness, gains.rotational_damping,
                       gains.max_torque, twist, w_WH - V_WT.template head<3>());

  CouplingWrenchOf<T> result;
  result.tool.F << torque.load, force.load;
  result.tool.K.template topLeftCorner<3, 3>() = torque.K;
  result.tool.K.template bottomRightCorner<3, 3>() = force.K;
  result.tool.B.template topLeftCorner<3, 3>() = torque.B;
  result.tool.B.template bottomRightCorner<3, 3>() = force.B;
  result.F_Ho_W_commanded << -torque.load - p_HT_W.cross(force.load),
      -force.load;
  return result;
}

template struct CouplingStretchOf<double>;
template CouplingStretchOf<double> ComputeStretch(const PoseVector&,
                                                  const PoseVector&,
                                                  const PoseVector&);
template CouplingWrenchOf<double> ComputeCoupling(
    const PoseVector&, const Vec6&, const PoseVector&, const PoseVector&,
    const Vec6&, const CouplingGains&);
template CouplingWrenchOf<AutoDiff> ComputeCoupling(
    const PoseVectorOf<AutoDiff>&, const Vec6Of<AutoDiff>&, const PoseVector&,
    const PoseVectorOf<AutoDiff>&, const Vec6Of<AutoDiff>&,
    const CouplingGains&);

}  // namespace drake_haptics
