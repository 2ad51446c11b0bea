#include "cluster_gradient.h"

#include <algorithm>
#include <span>

#include "contact_patch.h"
#include "shared_stiffness.h"

namespace drake_haptics {
namespace {

using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

// Step of the differences, as a share of the pressure layer.
constexpr double kStepShare = 1e-4;

// A contact with the tool displaced a little.
Contact Displaced(const Contact& contact, const ContactGradient& gradient,
                  const Vec6& by) {
  Contact moved = contact;
  moved.distance += gradient.distance.dot(by);
  moved.nhat_BA_W += gradient.nhat_BA_W * by;
  moved.nhat_BA_W.normalize();
  moved.p_WC += gradient.p_WC * by;
  moved.extent += gradient.extent.dot(by);
  moved.flushness += gradient.flushness.dot(by);
  return moved;
}

// Derivative of C λ for λ that stays: the compliance of contacts of one object
// turns with their normals and changes with their shares. By differences, since
// shares are piecewise functions of all contacts.
Rows6 YieldOf(std::span<const Contact> contacts,
              std::span<const ContactGradient> gradients,
              const Cluster* clusters, double tolerance) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  Eigen::VectorXd compression(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    compression[i] = clusters[i].compression;
  }
  std::vector<Contact> moved(contacts.size());
  std::vector<const Contact*> pointers;
  for (const Contact& contact : moved) pointers.push_back(&contact);
  const auto yield_at = [&](const Vec6& by) -> Eigen::VectorXd {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      moved[i] = Displaced(contacts[i], gradients[i], by);
    }
    return SkinCompliance(pointers, tolerance) * compression;
  };
  const double step = kStepShare * kPressureLayerShare * tolerance;
  Rows6 yield(count, 6);
  for (int k = 0; k < 6; ++k) {
    const Vec6 by = step * Vec6::Unit(k);
    yield.col(k) = (yield_at(by) - yield_at(-by)) / (2 * step);
  }
  return yield;
}

}  // namespace

std::vector<ClusterGradient> FindOctreeGradients(
    const std::vector<Contact>& contacts,
    const std::vector<ContactGradient>& gradients, const ClusterSet& set,
    double tolerance) {
  std::vector<ClusterGradient> found(set.clusters.size());
  std::vector<Vec3> direction(set.clusters.size(), Vec3::Zero());
  std::vector<double> weight(set.clusters.size(), 0.0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (set.label[i] < 0) continue;
    const Contact& contact = contacts[i];
    const ContactGradient& gradient = gradients[i];
    const Cluster& cluster = set.clusters[set.label[i]];
    ClusterGradient& sum = found[set.label[i]];
    const double w = tolerance - contact.distance;
    sum.nhat_BA_W +=
        w * gradient.nhat_BA_W - contact.nhat_BA_W * gradient.distance;
    sum.p_WC +=
        w * gradient.p_WC - (contact.p_WC - cluster.p_WC) * gradient.distance;
    if (contact.distance == cluster.distance) {
      sum.compression = -gradient.distance;
    }
    direction[set.label[i]] += w * contact.nhat_BA_W;
    weight[set.label[i]] += w;
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Vec3& n = set.clusters[k].nhat_BA_W;
    Mat36& turn = found[k].nhat_BA_W;
    turn -= n * (n.transpose() * turn);
    turn /= direction[k].norm();
    found[k].p_WC /= weight[k];
  }
  return found;
}

std::vector<ClusterGradient> FindSharedGradients(
    const std::vector<Contact>& contacts,
    const std::vector<ContactGradient>& gradients, const ClusterSet& set,
    double tolerance) {
  const auto count = static_cast<Eigen::Index>(set.clusters.size());
  std::vector<Contact> pushing;
  std::vector<ContactGradient> motion;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (set.label[i] < 0) continue;
    pushing.push_back(contacts[i]);
    motion.push_back(gradients[i]);
  }
  // C λ = w, so that λ changes by C⁻¹ (dw − dC λ).
  Rows6 yielded(count, 6);
  for (Eigen::Index first = 0, end; first < count; first = end) {
    end = first;
    while (end < count && pushing[end].object == pushing[first].object) ++end;
    yielded.middleRows(first, end - first) =
        -YieldOf({pushing.data() + first, pushing.data() + end},
                 {motion.data() + first, motion.data() + end},
                 set.clusters.data() + first, tolerance);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    yielded.row(i) -= motion[i].distance;
  }
  const Eigen::Map<const Eigen::MatrixXd> H(set.coupling.data(), count, count);
  const Rows6 compression = H * yielded;
  const double layer = kPressureLayerShare * tolerance;
  std::vector<ClusterGradient> found(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Cluster& cluster = set.clusters[i];
    const double w = tolerance - cluster.distance;
    found[i].compression = compression.row(i);
    found[i].damping_share = compression.row(i) / std::max(w, layer);
    if (w > layer) {
      found[i].damping_share += cluster.damping_share / w * motion[i].distance;
    }
    found[i].nhat_BA_W = motion[i].nhat_BA_W;
    found[i].p_WC = motion[i].p_WC;
  }
  return found;
}

}  // namespace drake_haptics
