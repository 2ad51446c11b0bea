#include "law/wrench_model.h"

namespace drake_haptics {
namespace {

template <typename T>
using RowMajor6 = Eigen::Matrix<T, 6, 6, Eigen::RowMajor>;

}  // namespace

template <typename T>
WrenchModelVectorOf<T> ToVector(const WrenchModelOf<T>& model) {
  WrenchModelVectorOf<T> vector;
  vector.template head<6>() = model.F;
  Eigen::Map<RowMajor6<T>>(vector.data() + 6) = model.K;
  Eigen::Map<RowMajor6<T>>(vector.data() + 42) = model.B;
  return vector;
}

template <typename T>
WrenchModelOf<T> ToWrenchModel(
    const Eigen::Matrix<T, kWrenchModelSize, 1>& vector) {
  WrenchModelOf<T> model;
  model.F = vector.template head<6>();
  model.K = Eigen::Map<const RowMajor6<T>>(vector.data() + 6);
  model.B = Eigen::Map<const RowMajor6<T>>(vector.data() + 42);
  return model;
}

template WrenchModelVector ToVector<double>(const WrenchModel&);
template WrenchModelVectorOf<AutoDiff> ToVector<AutoDiff>(
    const WrenchModelOf<AutoDiff>&);
template WrenchModel ToWrenchModel<double>(const WrenchModelVector&);
template WrenchModelOf<AutoDiff> ToWrenchModel<AutoDiff>(
    const WrenchModelVectorOf<AutoDiff>&);

}  // namespace drake_haptics
