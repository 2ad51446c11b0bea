#include "law/penalty_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <type_traits>

#include "base/autodiff.h"
#include "base/require.h"
#include "law/approach.h"

namespace drake_haptics {
namespace {

template <typename T>
using Wrenches = Eigen::Matrix<T, 6, Eigen::Dynamic>;

// Σ k H_ij G_i G_jᵀ. With U = M Σ r φ Gᵀ that is, object by object,
//   k Uᵀ U + k Σ r (G − Uᵀ φ)(G − Uᵀ φ)ᵀ:
// so the sum stays positive semidefinite under rounding.
Mat6 SumCoupled(const CompressionJacobian& coupling, const Wrenches<double>& G,
                const Eigen::VectorXd& k) {
  Mat6 K = Mat6::Zero();
  for (Eigen::Index i = 0, end; i < G.cols(); i = end) {
    const auto& members = coupling.members;
    const std::int32_t place = members[i].skin;
    end = i + 1;
    if (place < 0) {
      K += k[i] * members[i].slope * G.col(i) * G.col(i).transpose();
      continue;
    }
    while (end < G.cols() && members[end].skin == place) ++end;
    const auto& [features, factor] = coupling.skins[place];
    Wrenches<double> sums = Wrenches<double>::Zero(6, features.cols());
    for (Eigen::Index j = i; j < end; ++j) {
      sums.col(members[j].direction) += members[j].slope * G.col(j);
    }
    const auto L = factor.triangularView<Eigen::Lower>();
    Eigen::Matrix<double, Eigen::Dynamic, 6> U = features * sums.transpose();
    L.solveInPlace(U);
    L.transpose().solveInPlace(U);
    const Wrenches<double> yielded = U.transpose() * features;
    Mat6 in_skin = U.transpose() * U;
    for (Eigen::Index j = i; j < end; ++j) {
      if (members[j].slope == 0) continue;
      const Vec6 own = G.col(j) - yielded.col(members[j].direction);
      in_skin += members[j].slope * own * own.transpose();
    }
    K += k[i] * in_skin;
  }
  return K;
}

Mat6Of<AutoDiff> SumCoupled(const MovingCompressionJacobian& coupling,
                            const Wrenches<AutoDiff>& G,
                            const Eigen::VectorXd& k) {
  Mat6Of<AutoDiff> K = Mat6Of<AutoDiff>::Zero();
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    const auto& [first, count, row] = coupling.members[i];
    const Eigen::Map<const VectorOf<AutoDiff>> H(coupling.together.data() + row,
                                                 count);
    K += k[i] * G.col(i) * (G.middleCols(first, count) * H).transpose();
  }
  return K;
}

// Σ k H_ij G_i G_jᵀ. Clusters of different objects are not coupled.
template <typename T>
Mat6Of<T> Stiffness(const ClusterSetOf<T>& set, const Wrenches<T>& G,
                    const std::vector<ContactMaterial>& materials) {
  Eigen::VectorXd k(G.cols());
  for (Eigen::Index i = 0; i < k.size(); ++i) {
    k[i] = materials[set.clusters[i].object].stiffness;
  }
  if (!set.coupling.empty()) return SumCoupled(set.coupling, G, k);
  Wrenches<T> kG = G;
  for (Eigen::Index i = 0; i < G.cols(); ++i) kG.col(i) *= k[i];
  if constexpr (std::is_same_v<T, double>) {
    return kG * G.transpose();
  } else {
    return kG.lazyProduct(G.transpose());  // no blocks for a processor's cache
  }
}

}  // namespace

void RequireMaterial(const ContactMaterial& material) {
  RequireNotNegative(material.stiffness, "stiffness");
  RequireNotNegative(material.damping, "damping");
}

template <typename T>
std::vector<Vec6Of<T>> PenaltyWrenchOf<T>::SumByObject() const {
  std::vector<Vec6Of<T>> F_objects_W(num_objects, Vec6Of<T>::Zero());
  for (std::size_t i = 0; i < object.size(); ++i) {
    F_objects_W[object[i]] += F_cluster_W[i];
  }
  return F_objects_W;
}

template <typename T>
std::vector<T> PenaltyWrenchOf<T>::NormalForces() const {
  std::vector<T> forces;
  forces.reserve(f_cluster_W.size());
  for (const Vec3Of<T>& f_W : f_cluster_W) forces.push_back(LengthOf(f_W));
  return forces;
}

template <typename T>
PenaltyWrenchOf<T> ComputePenaltyWrench(
    const ClusterSetOf<T>& clusters, const MovingFrameOf<T>& tool,
    const std::vector<MovingFrameOf<T>>& objects,
    const std::vector<ContactMaterial>& materials) {
  if (materials.size() != objects.size()) {
    throw std::invalid_argument("there must be one material for each object");
  }
  PenaltyWrenchOf<T> result;
  result.num_objects = static_cast<int>(objects.size());
  result.f_cluster_W.reserve(clusters.clusters.size());
  result.F_cluster_W.reserve(clusters.clusters.size());
  result.object.reserve(clusters.clusters.size());
  Wrenches<T> wrenches(6, clusters.clusters.size());
  Eigen::Index next = 0;
  for (const ClusterOf<T>& cluster : clusters.clusters) {
    const MovingFrameOf<T>& object = ObjectAt(objects, cluster.object);
    const ContactMaterial& material = materials[cluster.object];
    RequireMaterial(material);
    const Vec6Of<T> G = tool.Lever(cluster.p_WC, cluster.nhat_BA_W);
    const Vec6Of<T> G_object = object.Lever(cluster.p_WC, cluster.nhat_BA_W);
    // Eq. 8 as the power of a unit force: n·v of both bodies at the contact.
    const T speed = G.dot(tool.V_WF) - G_object.dot(object.V_WF);
    const T damping = material.damping * cluster.damping_share;
    const Approach<T> approach(speed);
    T magnitude = material.stiffness * cluster.compression;
    magnitude -= damping * approach.speed;
    result.tool.B += approach.engaged * damping * G * G.transpose();
    wrenches.col(next++) = G;
    result.tool.F += magnitude * G;
    result.F_cluster_W.push_back(T(-magnitude) * G_object);
    result.object.push_back(cluster.object);
    result.f_cluster_W.push_back(magnitude * cluster.nhat_BA_W);
  }
  if (next > 0) result.tool.K = Stiffness(clusters, wrenches, materials);
  return result;
}

template struct PenaltyWrenchOf<double>;
template struct PenaltyWrenchOf<AutoDiff>;
template PenaltyWrench ComputePenaltyWrench(
    const ClusterSet&, const MovingFrame&, const std::vector<MovingFrame>&,
    const std::vector<ContactMaterial>&);
template PenaltyWrenchOf<AutoDiff> ComputePenaltyWrench(
    const ClusterSetOf<AutoDiff>&, const MovingFrameOf<AutoDiff>&,
    const std::vector<MovingFrameOf<AutoDiff>>&,
    const std::vector<ContactMaterial>&);

}  // namespace drake_haptics
