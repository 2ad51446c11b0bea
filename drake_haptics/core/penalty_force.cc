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

using Wrenches = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// Σ k H_ij G_i G_jᵀ. Clusters of different objects have nothing in common.
Mat6 Stiffness(const ClusterSet& set, const Wrenches& G,
               const std::vector<ContactMaterial>& materials) {
  const Eigen::Index count = G.cols();
  Wrenches kG = G;
  for (Eigen::Index i = 0; i < count; ++i) {
    kG.col(i) *= materials[set.clusters[i].object].stiffness;
  }
  if (set.coupling.empty()) return kG * G.transpose();
  const Eigen::Map<const Eigen::MatrixXd> H(set.coupling.data(), count, count);
  return kG * H * G.transpose();
}

}  // namespace

PenaltyWrench ComputePenaltyWrench(
    const ClusterSet& clusters, const MovingFrame& tool,
    const std::vector<MovingFrame>& objects,
    const std::vector<ContactMaterial>& materials) {
  if (materials.size() != objects.size()) {
    throw std::invalid_argument("there must be one material for each object");
  }
  for (const ContactMaterial& material : materials) {
    RequireGain(material.stiffness, "stiffness");
    RequireGain(material.damping, "damping");
  }
  PenaltyWrench result;
  result.F_objects_W.assign(objects.size(), Vec6::Zero());
  Wrenches wrenches(6, clusters.clusters.size());
  Eigen::Index next = 0;
  for (const Cluster& cluster : clusters.clusters) {
    const MovingFrame& object = objects.at(cluster.object);
    const ContactMaterial& material = materials[cluster.object];
    const Vec6 G = Wrench(cluster.p_WC, cluster.nhat_BA_W, tool);
    const Vec6 G_object = Wrench(cluster.p_WC, cluster.nhat_BA_W, object);
    // Eq. 8, as power of a unit force: n·v at the contact, of either body.
    const double speed = G.dot(tool.V_WF) - G_object.dot(object.V_WF);
    const double damping = material.damping * cluster.damping_share;
    double magnitude = material.stiffness * cluster.compression;
    if (speed < 0) {
      magnitude -= damping * speed;
      result.tool.B += damping * G * G.transpose();
    }
    wrenches.col(next++) = G;
    result.tool.F += magnitude * G;
    result.F_objects_W[cluster.object] -= magnitude * G_object;
    result.f_cluster_W.push_back(magnitude * cluster.nhat_BA_W);
  }
  if (next > 0) result.tool.K = Stiffness(clusters, wrenches, materials);
  return result;
}

}  // namespace drake_haptics
