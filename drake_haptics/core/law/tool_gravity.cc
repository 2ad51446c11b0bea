#include "law/tool_gravity.h"

#include <Eigen/Geometry>

namespace drake_haptics {

template <typename T>
Vec6Of<T> ToolWeight(const Eigen::Matrix<T, 7, 1>& q_WT, const Vec3& p_TTcm,
                     const Vec3& weight_W) {
  const Vec3Of<T> weight = weight_W.template cast<T>();
  const Vec3Of<T> p_TTcm_W = QuaternionOf(q_WT) * p_TTcm.template cast<T>();
  Vec6Of<T> wrench;
  wrench << p_TTcm_W.cross(weight), weight;
  return wrench;
}

template Vec6 ToolWeight<double>(const PoseVector&, const Vec3&, const Vec3&);
template Vec6Of<AutoDiff> ToolWeight<AutoDiff>(const PoseVectorOf<AutoDiff>&,
                                               const Vec3&, const Vec3&);

}  // namespace drake_haptics
