#include "tool/tick_energy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace drake_haptics {
namespace {

// Work on the tool of the wrench that its step applies, J.
double WorkOnTool(const WrenchModel& start, const TickMotion& motion) {
  const Vec6 delta = motion.delta();
  return delta.dot(start.F - start.B * motion.dV() - start.K * delta);
}

}  // namespace

TickEnergy SourceEnergy(const WrenchModel& start, const WrenchModel& end,
                        const TickMotion& motion) {
  const Vec6 delta = motion.delta();
  const Vec6 F_rest = start.F + start.B * motion.V;
  const Vec6 F_rest_end = end.F + end.B * motion.V_next;
  TickEnergy energy;
  energy.from_tool = -WorkOnTool(start, motion);
  energy.damped = delta.dot(start.B * motion.V_next);
  energy.bound = std::max(0.0, std::max(0.0, delta.dot(F_rest - F_rest_end)) -
                                   delta.dot(start.K * delta));
  return energy;
}

TickEnergy CouplingEnergy(const WrenchModel& start, const CouplingGains& gains,
                          const CouplingStretch& from,
                          const CouplingStretch& to, const TickMotion& motion) {
  const double k = gains.stiffness;
  const double kr = gains.rotational_stiffness;
  const Vec6 delta = motion.delta();
  const Vec3 turn = motion.turn_dp.head<3>();
  const Vec3 lever_shift = turn.cross(from.p_HT_W);
  Vec6 held = motion.turn_dp;
  held.tail<3>() += lever_shift;
  const Vec6 apart = held - delta;
  const Vec6 spring = from.Load(gains);

  const Vec3 turn_tool = delta.head<3>();
  const double angle = std::min(
      std::numbers::pi, from.twist.norm() + turn.norm() + turn_tool.norm());
  const double spring_excess =
      0.5 * k * (to.stretch - from.stretch).squaredNorm() +
      0.5 * kr *
          (apart.head<3>().squaredNorm() +
           angle * turn.cross(turn_tool).norm()) +
      spring.tail<3>().dot(to.p_HT_W - from.p_HT_W - lever_shift);

  TickEnergy energy;
  energy.from_tool = -WorkOnTool(start, motion);
  energy.from_handle = held.dot(start.F);
  energy.damped = apart.dot(start.B * apart) / motion.h;
  const double damped_as_sampled =
      (start.F - spring).dot(apart) + delta.dot(start.B * motion.dV());
  energy.bound =
      std::max(0.0, spring_excess + energy.damped - damped_as_sampled -
                        delta.dot(start.K * delta));
  return energy;
}

double GyroscopicEnergy(const ToolMotionTerms& start,
                        const ToolMotionTerms& end, const TickMotion& motion) {
  const Vec6& V = motion.V_next;
  return 0.5 * V.dot((end.M - start.M) * V) - motion.h * V.dot(start.b);
}

}  // namespace drake_haptics
