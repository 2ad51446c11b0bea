#include "tool/stored_energy.h"

namespace drake_haptics {

double ContactEnergy(const ClusterSet& clusters,
                     const std::vector<double>& stiffness, double tolerance) {
  double energy = 0;
  for (const Cluster& cluster : clusters.clusters) {
    energy += 0.5 * ObjectAt(stiffness, cluster.object) * cluster.compression *
              (tolerance - cluster.distance);
  }
  return energy;
}

double WeightEnergy(const PoseVector& q_WT, const Vec3& p_TTcm,
                    const Vec3& weight_W) {
  return -weight_W.dot(q_WT.tail<3>() + QuaternionOf(q_WT) * p_TTcm);
}

}  // namespace drake_haptics
