#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "base/autodiff.h"
#include "base/types.h"

/// Poses that Python passes in. One pose is a (4, 4) rigid matrix, a (7,)
/// vector [qw qx qy qz x y z], or an object with Drake's
/// `RigidTransform.GetAsMatrix4()`; a series is (n, 4, 4), (n, 7), or one pose
/// of a body at rest.
namespace drake_haptics {

/// @param name the argument, for messages.
/// @throws std::invalid_argument unless it is one pose: finite and rigid.
Pose ToPose(nanobind::handle value, const char* name);

/// Pose i of poses with derivatives, stored one after another with 7 numbers
/// each.
/// @throws std::invalid_argument unless its values are a pose.
PoseOf<AutoDiff> PoseAt(const AutoDiffVector& poses, Eigen::Index i,
                        const char* name);

/// The poses of one body over a trajectory.
class PoseSeries {
 public:
  /// @throws std::invalid_argument unless all items are poses.
  PoseSeries(nanobind::handle value, const char* name);

  bool at_rest() const { return at_rest_; }
  std::size_t size() const { return poses_.size(); }
  const Pose& operator[](std::size_t i) const {
    return poses_[at_rest_ ? 0 : i];
  }

 private:
  bool at_rest_;
  std::vector<Pose> poses_;
};

/// Number of poses of a trajectory of two bodies.
/// @throws std::invalid_argument if both move and their numbers differ.
std::size_t CommonSize(const PoseSeries& X_WA, const PoseSeries& X_WB);

}  // namespace drake_haptics
