#include "wrench_model.h"

namespace drake_haptics {
namespace {

using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

}  // namespace

WrenchModelVector ToVector(const WrenchModel& model) {
  WrenchModelVector vector;
  vector.head<6>() = model.F;
  Eigen::Map<RowMajor6>(vector.data() + 6) = model.K;
  Eigen::Map<RowMajor6>(vector.data() + 42) = model.B;
  return vector;
}

WrenchModel FromVector(const WrenchModelVector& vector) {
  WrenchModel model;
  model.F = vector.head<6>();
  model.K = Eigen::Map<const RowMajor6>(vector.data() + 6);
  model.B = Eigen::Map<const RowMajor6>(vector.data() + 42);
  return model;
}

}  // namespace drake_haptics
