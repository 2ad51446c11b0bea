#include "penalty_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "approach.h"

namespace drake_haptics {
namespace {

void RequireGain(double value, const char* name) {
  if (!std::isfinite(value) || value < 0) {
    throw std::invalid_argument(std::string(name) +
                                " must be finite and at least 0");
  }
}

// The direction along which a unit force n at p acts on a frame, as a wrench.
template <typename T>
Vec6Of<T> Wrench(const Vec3Of<T>& p_WC, const Vec3Of<T>& n,
                 const MovingFrameOf<T>& frame) {
  Vec6Of<T> wrench;
  wrench << (p_WC - frame.p_WF).cross(n), n;
  return wrench;
}

template <typename T>
using Wrenches = Eigen::Matrix<T, 6, Eigen::Dynamic>;

// Σ k H_ij G_i G_jᵀ. Clusters of different objects have nothing in common. The
// clusters of a direction count by their mean, and by what they differ from it,
// so that no rounding makes the sum less than positive semidefinite.
template <typename T>
Mat6Of<T> Stiffness(const ClusterSetOf<T>& set, const Wrenches<T>& G,
                    const std::vector<ContactMaterial>& materials) {
  const auto stiffness = [&](Eigen::Index i) {
    return materials[set.clusters[i].object].stiffness;
  };
  if (set.coupling.empty()) {
    Wrenches<T> kG = G;
    for (Eigen::Index i = 0; i < G.cols(); ++i) kG.col(i) *= stiffness(i);
    return kG * G.transpose();
  }
  const auto& members = set.coupling.members;
  const auto& directions = set.coupling.directions;
  Wrenches<T> mean = Wrenches<T>::Zero(6, directions.size());
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    const auto a = members[i].direction;
    if (directions[a].slope == 0.0) continue;
    mean.col(a) += G.col(i) * T(members[i].slope / directions[a].slope);
  }
  Mat6Of<T> K = Mat6Of<T>::Zero();
  std::vector<double> k(directions.size());
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    const auto a = members[i].direction;
    k[a] = stiffness(i);
    // One that is alone is its direction's mean.
    if (members[i].slope == directions[a].slope) continue;
    const Vec6Of<T> beside = G.col(i) - mean.col(a);
    K += T(k[a] * members[i].slope) * beside * beside.transpose();
  }
  for (std::size_t a = 0; a < directions.size(); ++a) {
    const auto& [slope, first, count, row] = directions[a];
    const Eigen::Map<const VectorOf<T>> N(set.coupling.together.data() + row,
                                          count);
    K += k[a] * mean.col(a) * (mean.middleCols(first, count) * N).transpose();
  }
  return K;
}

}  // namespace

template <typename T>
PenaltyWrenchOf<T> ComputePenaltyWrench(
    const ClusterSetOf<T>& clusters, const MovingFrameOf<T>& tool,
    const std::vector<MovingFrameOf<T>>& objects,
    const std::vector<ContactMaterial>& materials) {
  if (materials.size() != objects.size()) {
    throw std::invalid_argument("there must be one material for each object");
  }
  for (const ContactMaterial& material : materials) {
    RequireGain(material.stiffness, "stiffness");
    RequireGain(material.damping, "damping");
  }
  PenaltyWrenchOf<T> result;
  result.F_objects_W.assign(objects.size(), Vec6Of<T>::Zero());
  Wrenches<T> wrenches(6, clusters.clusters.size());
  Eigen::Index next = 0;
  for (const ClusterOf<T>& cluster : clusters.clusters) {
    const MovingFrameOf<T>& object = objects.at(cluster.object);
    const ContactMaterial& material = materials[cluster.object];
    const Vec6Of<T> G = Wrench(cluster.p_WC, cluster.nhat_BA_W, tool);
    const Vec6Of<T> G_object = Wrench(cluster.p_WC, cluster.nhat_BA_W, object);
    // Eq. 8, as power of a unit force: n·v at the contact, of either body.
    const T speed = G.dot(tool.V_WF) - G_object.dot(object.V_WF);
    const T damping = material.damping * cluster.damping_share;
    const Approach<T> approach(speed);
    T magnitude = material.stiffness * cluster.compression;
    magnitude -= damping * approach.speed;
    result.tool.B += approach.engaged * damping * G * G.transpose();
    wrenches.col(next++) = G;
    result.tool.F += magnitude * G;
    result.F_objects_W[cluster.object] -= magnitude * G_object;
    result.f_cluster_W.push_back(magnitude * cluster.nhat_BA_W);
  }
  if (next > 0) result.tool.K = Stiffness(clusters, wrenches, materials);
  return result;
}

template PenaltyWrench ComputePenaltyWrench(
    const ClusterSet&, const MovingFrame&, const std::vector<MovingFrame>&,
    const std::vector<ContactMaterial>&);
template PenaltyWrenchOf<AutoDiff> ComputePenaltyWrench(
    const ClusterSetOf<AutoDiff>&, const MovingFrameOf<AutoDiff>&,
    const std::vector<MovingFrameOf<AutoDiff>>&,
    const std::vector<ContactMaterial>&);

}  // namespace drake_haptics
