#include "tool_gravity.h"

#include <Eigen/Geometry>

namespace drake_haptics {

Vec6 ToolWeight(const PoseVector& q_WT, const Vec3& p_TTcm,
                const Vec3& weight_W) {
  const Vec3 p_TTcm_W = QuaternionOf(q_WT) * p_TTcm;
  Vec6 wrench;
  wrench << p_TTcm_W.cross(weight_W), weight_W;
  return wrench;
}

}  // namespace drake_haptics
