#pragma once

#include "base/rotation.h"

namespace drake_haptics {

/// Changes motions from a frame B to a frame A in which B is fixed, and
/// wrenches from A to B. Spatial vectors keep their points.
class FrameChange {
 public:
  /// @param q_AB pose of B in A.
  /// @throws std::invalid_argument unless it is a pose.
  explicit FrameChange(const PoseVector& q_AB)
      : X_AB_(PoseFromVector(q_AB, "X_AB")), q_AB_(QuaternionOf(q_AB)) {}

  /// Returns [X_AH; V_AH] for [X_BH; V_BH]. The quaternion keeps its norm.
  Eigen::Matrix<double, 13, 1> ChangeMotion(const PoseVector& q_BH,
                                            const Vec6& V_BH) const {
    const Eigen::Quaterniond turn =
        q_AB_ * Eigen::Quaterniond(q_BH[0], q_BH[1], q_BH[2], q_BH[3]);
    Eigen::Matrix<double, 13, 1> motion;
    motion << turn.w(), turn.vec(), X_AB_ * Vec3(q_BH.tail<3>()),
        X_AB_.R * V_BH.head<3>(), X_AB_.R * V_BH.tail<3>();
    return motion;
  }

  /// Expresses a spatial vector in B.
  Vec6 ChangeBack(const Vec6& F_A) const {
    Vec6 F_B;
    F_B << X_AB_.R.transpose() * F_A.head<3>(),
        X_AB_.R.transpose() * F_A.tail<3>();
    return F_B;
  }

  /// Expresses in B the slope of a spatial vector with respect to a motion.
  Mat6 ChangeBack(const Mat6& K_A) const {
    Mat6 K_B;
    for (int i = 0; i < 6; i += 3) {
      for (int j = 0; j < 6; j += 3) {
        K_B.block<3, 3>(i, j) =
            X_AB_.R.transpose() * K_A.block<3, 3>(i, j) * X_AB_.R;
      }
    }
    return K_B;
  }

 private:
  Pose X_AB_;
  Eigen::Quaterniond q_AB_;
};

}  // namespace drake_haptics
