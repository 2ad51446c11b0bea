#pragma once

#include <vector>

#include "bind/bind_array.h"
#include "law/penalty_force.h"

/// Frames and materials of all objects of a scene, in the core's own form:
/// there can be a thousand, and in most ticks none of them moves or changes.
namespace drake_haptics {

using Rows3 = Rows<double, 3>;
using Rows6 = Rows<double, 6>;

/// Origin and spatial velocity of each object.
struct ObjectFrames {
  std::vector<MovingFrame> frames;

  /// @throws std::invalid_argument unless both have one row for each object.
  ObjectFrames(const Rows3& p_WO, const Rows6& V_WO);
};

/// Contact stiffness and damping of each object.
struct ContactMaterials {
  std::vector<ContactMaterial> materials;

  /// @throws std::invalid_argument unless both have one entry for each object,
  ///         or if one is negative or not finite.
  ContactMaterials(const Eigen::VectorXd& stiffness,
                   const Eigen::VectorXd& damping);
};

}  // namespace drake_haptics
