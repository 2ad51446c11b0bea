#include "penalty_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace drake_haptics {
namespace {

void RequireGain(double value, const char* name) {
  if (!std::isfinite(value) || value < 0) {
    throw std::invalid_argument(std::string(name) +
                                " must be finite and at least 0");
  }
}

// The direction along which a unit force n at p acts on a frame, as a wrench.
Vec6 Wrench(const Vec3& p_WC, const Vec3& n, const MovingFrame& frame) {
  Vec6 wrench;
  wrench << (p_WC - frame.p_WF).cross(n), n;
  return wrench;
}

}  // namespace

PenaltyWrench ComputePenaltyWrench(const std::vector<Cluster>& clusters,
                                   const MovingFrame& tool,
                                   const std::vector<MovingFrame>& objects,
                                   const PenaltyGains& gains) {
  RequireGain(gains.stiffness, "stiffness");
  RequireGain(gains.damping, "damping");
  RequireGain(gains.tolerance, "tolerance");
  PenaltyWrench result;
  result.F_objects_W.assign(objects.size(), Vec6::Zero());
  for (const Cluster& cluster : clusters) {
    const MovingFrame& object = objects.at(cluster.object);
    const Vec6 G = Wrench(cluster.p_WC, cluster.nhat_BA_W, tool);
    const Vec6 G_object = Wrench(cluster.p_WC, cluster.nhat_BA_W, object);
    // Eq. 8, as power of a unit force: n·v at the contact, of either body.
    const double speed = G.dot(tool.V_WF) - G_object.dot(object.V_WF);
    const bool approaching = speed < 0;
    const double elastic =
        gains.stiffness * std::max(0.0, gains.tolerance - cluster.distance);
    const double magnitude =
        elastic + (approaching ? -gains.damping * speed : 0.0);
    result.tool.F += magnitude * G;
    result.tool.K += gains.stiffness * G * G.transpose();
    if (approaching) result.tool.B += gains.damping * G * G.transpose();
    result.F_objects_W[cluster.object] -= magnitude * G_object;
    result.f_cluster_W.push_back(magnitude * cluster.nhat_BA_W);
  }
  return result;
}

}  // namespace drake_haptics
