#pragma once

#include <Eigen/Core>
#include <vector>

#include "law/penalty_force.h"

/// What a tick needs to know of all objects of a scene, in the core's own form:
/// there can be a thousand, and none of them moves or changes in most ticks.
namespace drake_haptics {

using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// Where each object is and how it moves.
struct ObjectFrames {
  std::vector<MovingFrame> frames;

  /// @throws std::invalid_argument unless there is one of each for each object.
  ObjectFrames(const Rows3& p_WO, const Rows6& V_WO);
};

/// How each object answers contact.
struct ContactMaterials {
  std::vector<ContactMaterial> materials;

  /// @throws std::invalid_argument unless there is one of each for each object,
  ///         or if one is negative or not finite.
  ContactMaterials(const Eigen::VectorXd& stiffness,
                   const Eigen::VectorXd& damping);
};

}  // namespace drake_haptics
