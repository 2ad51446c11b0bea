#include "law/friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/require.h"
#include "law/stick_anchors.h"

namespace drake_haptics {
namespace {

// The clusters with friction, and the normal forces that they bear.
template <typename T>
struct Rubbing {
  static constexpr int kCapacity = AdhesiveContactsOf<T>::kCapacity;
  std::array<int, kCapacity> cluster;
  std::array<T, kCapacity> normal_force;
  int size = 0;
};

// Selects the strongest clusters if there are too many. They also bear the
// normal forces of the others on the same object, so that friction as a whole
// stays the same.
template <typename T>
Rubbing<T> FindRubbing(const std::vector<ClusterOf<T>>& clusters,
                       const std::vector<T>& normal_forces,
                       const std::vector<double>& coefficients) {
  const auto rubs = [&](int c) {
    const double normal_force = ValueOf(normal_forces[c]);
    return normal_force > 0 && std::isfinite(normal_force) &&
           coefficients[clusters[c].object] > 0;
  };
  const int num_clusters = static_cast<int>(clusters.size());
  Rubbing<T> rubbing;
  bool all = true;
  for (int c = 0; c < num_clusters; ++c) {
    if (!rubs(c)) continue;
    if (rubbing.size < Rubbing<T>::kCapacity) {
      rubbing.cluster[rubbing.size++] = c;
      continue;
    }
    all = false;
    int* const weakest = std::min_element(
        rubbing.cluster.begin(), rubbing.cluster.end(),
        [&](int a, int b) { return normal_forces[a] < normal_forces[b]; });
    if (normal_forces[*weakest] < normal_forces[c]) *weakest = c;
  }
  const auto sum = [&](int object, const auto& items, int size) {
    T total{0};
    for (int i = 0; i < size; ++i) {
      const int c = items(i);
      if (clusters[c].object == object && rubs(c)) total += normal_forces[c];
    }
    return total;
  };
  for (int k = 0; k < rubbing.size; ++k) {
    const int c = rubbing.cluster[k];
    rubbing.normal_force[k] = normal_forces[c];
    if (all) continue;
    const int object = clusters[c].object;
    const T of_all = sum(object, [](int i) { return i; }, num_clusters);
    const T of_chosen =
        sum(object, [&](int i) { return rubbing.cluster[i]; }, rubbing.size);
    rubbing.normal_force[k] *= T(of_all / of_chosen);
  }
  return rubbing;
}

// Adds a force at the point r from the tool's origin to its wrench.
template <typename T>
void AddAt(const Vec3Of<T>& r, const FrictionForceOf<T>& force,
           WrenchModelOf<T>* wrench) {
  wrench->F.template head<3>() += r.cross(force.f_W);
  wrench->F.template tail<3>() += force.f_W;
  // Derivative of the point's displacement by the tool's, the point frozen.
  Eigen::Matrix<T, 3, 6> J;
  const T zero(0.0), one(1.0);
  J << zero, r.z(), -r.y(), one, zero, zero,  //
      -r.z(), zero, r.x(), zero, one, zero,   //
      r.y(), -r.x(), zero, zero, zero, one;
  const Eigen::Matrix<T, 3, 6> KJ = force.K_W * J;
  wrench->K.noalias() += J.transpose() * KJ;
}

}  // namespace

StickSlipModel::StickSlipModel(std::vector<double> coefficients,
                               const std::vector<bool>& moves,
                               const FrictionParameters& parameters)
    : coefficients_(std::move(coefficients)), parameters_(parameters) {
  if (coefficients_.size() != moves.size()) {
    throw std::invalid_argument(
        "coefficient and moves must have one item for each object");
  }
  for (std::size_t i = 0; i < coefficients_.size(); ++i) {
    const std::string name = "coefficient[" + std::to_string(i) + "]";
    RequireNotNegative(coefficients_[i], name.c_str());
    moving_index_.push_back(moves[i] ? num_moving_++ : -1);
  }
  if (!(parameters.static_ratio >= 1 &&
        std::isfinite(parameters.static_ratio))) {
    throw std::invalid_argument(
        "static_ratio must be finite and at least 1, is " +
        std::to_string(parameters.static_ratio));
  }
  RequirePositive(parameters.break_away, "break_away_m");
  RequirePositive(parameters.reach, "reach_m");
}

template <typename T>
FrictionStepOf<T> StickSlipModel::Step(
    const T* state, const std::vector<ClusterOf<T>>& clusters,
    const std::vector<T>& normal_forces, const Eigen::Matrix<T, 7, 1>& q_WT,
    const T* q_WO) const {
  using PoseMap = Eigen::Map<const PoseVectorOf<T>>;
  const int poses_size = 7 * (1 + num_moving_);
  const RigidMoveOf<T> tool_move(PoseMap(state), q_WT);

  const auto object_move = [&](int object) {
    const int m = moving_index_[object];
    return m < 0 ? RigidMoveOf<T>()
                 : RigidMoveOf<T>(PoseMap(state + 7 * (1 + m)),
                                  PoseMap(q_WO + 7 * m));
  };

  CarriedContactsOf<T> last;
  for (const AdhesiveContactOf<T>& contact :
       AdhesiveContactsOf<T>::Read(state + poses_size)) {
    if (contact.object < 0 || contact.object >= num_objects()) continue;
    CarriedContactOf<T>& carried = last.items[last.size];
    carried = Carry(contact, tool_move, object_move(contact.object));
    // A pose with NaN must not stay in the state.
    if (ValuesOf(carried.on_object.z_W).allFinite()) ++last.size;
  }

  const Rubbing<T> rubbing =
      FindRubbing(clusters, normal_forces, coefficients_);
  AdhesiveContactsOf<T> now;
  for (int k = 0; k < rubbing.size; ++k) {
    const ClusterOf<T>& cluster = clusters[rubbing.cluster[k]];
    now.push_back({cluster.object, cluster.p_WC, cluster.nhat_BA_W,
                   Vec3Of<T>::Zero(), rubbing.normal_force[k], T(1.0)});
  }
  TransportAnchors(last, parameters_.reach, &now);

  FrictionStepOf<T> step;
  step.f_cluster_W.assign(clusters.size(), Vec3Of<T>::Zero());
  step.sliding.assign(clusters.size(), 0);
  for (int k = 0; k < rubbing.size; ++k) {
    const int c = rubbing.cluster[k];
    const Vec3Of<T>& p_WC = now[k].p_WC;
    const Vec3Of<T> motion = tool_move.Displacement(p_WC) -
                             object_move(now[k].object).Displacement(p_WC);
    const FrictionForceOf<T> force =
        ApplyStickSlip(rubbing.normal_force[k], coefficients_[now[k].object],
                       parameters_, motion, &now[k]);
    AddAt<T>(now[k].p_WC - q_WT.template tail<3>(), force, &step.tool);
    step.f_cluster_W[c] = force.f_W;
    step.sliding[c] = force.sliding;
    step.stored -= T(0.5 * force.f_W.dot(now[k].z_W));
  }

  step.next_state.resize(state_size(), T(0.0));
  std::copy_n(q_WT.data(), 7, step.next_state.begin());
  std::copy_n(q_WO, 7 * num_moving_, step.next_state.begin() + 7);
  now.Write(step.next_state.data() + poses_size);
  return step;
}

template FrictionStep StickSlipModel::Step(const double*,
                                           const std::vector<Cluster>&,
                                           const std::vector<double>&,
                                           const PoseVector&,
                                           const double*) const;
template FrictionStepOf<AutoDiff> StickSlipModel::Step(
    const AutoDiff*, const std::vector<ClusterOf<AutoDiff>>&,
    const std::vector<AutoDiff>&, const PoseVectorOf<AutoDiff>&,
    const AutoDiff*) const;

}  // namespace drake_haptics
