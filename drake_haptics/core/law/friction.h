#pragma once

#include <vector>

#include "base/rotation.h"
#include "base/types.h"
#include "law/clustering.h"
#include "law/friction_law.h"
#include "law/wrench_model.h"

namespace drake_haptics {

/// Friction of all clusters at one tick.
template <typename T>
struct FrictionStepOf {
  WrenchModelOf<T> tool;               ///< on the tool at To
  std::vector<Vec3Of<T>> f_cluster_W;  ///< on the tool, at each cluster, N
  std::vector<char> sliding;           ///< whether each cluster slides
  T stored{0};                         ///< elastic energy of the contacts, J
  std::vector<T> next_state;
};
using FrictionStep = FrictionStepOf<double>;

/// Stick-slip friction of a tool on objects, for the representative contacts of
/// clusters (paper, 4.4.2). It is a function of the last tick's state and of
/// the present inputs, without a sample of delay.
///
/// The state is [X_WT (7); X_WO (7) of each object that moves; 32 slots of
/// AdhesiveContacts]: the poses and contacts of the last tick.
class StickSlipModel {
 public:
  /// @param coefficients sliding coefficient μ of each object; 0 for no
  ///     friction.
  /// @param moves whether each object moves.
  /// @throws std::invalid_argument for parameters out of bounds.
  StickSlipModel(std::vector<double> coefficients,
                 const std::vector<bool>& moves,
                 const FrictionParameters& parameters);

  int num_objects() const { return static_cast<int>(coefficients_.size()); }
  int num_moving() const { return num_moving_; }
  int state_size() const {
    return 7 * (1 + num_moving_) + AdhesiveContactsOf<double>::kCapacity *
                                       AdhesiveContactsOf<double>::kSlotSize;
  }

  /// Returns the friction on the clusters. If there are more than 32, the
  /// strongest bear the normal force of all on their object.
  /// @param state of the last tick, state_size() long.
  /// @param normal_forces N of each cluster.
  /// @param q_WO poses of the objects that move, num_moving() of them.
  template <typename T>
  FrictionStepOf<T> Step(const T* state,
                         const std::vector<ClusterOf<T>>& clusters,
                         const std::vector<T>& normal_forces,
                         const Eigen::Matrix<T, 7, 1>& q_WT,
                         const T* q_WO) const;

 private:
  std::vector<double> coefficients_;
  std::vector<int> moving_index_;  // of each object; negative if it rests
  int num_moving_ = 0;
  FrictionParameters parameters_;
};

}  // namespace drake_haptics
