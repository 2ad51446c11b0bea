#include "tool/handle_model.h"

#include "base/positive_semidefinite.h"
#include "base/symmetric_eigen.h"

namespace drake_haptics {
namespace {

// Nothing holds the tool in directions in which coupling and contact together
// are softer than this share of the stiffest direction.
constexpr double kSoftest = 1e-12;

// Motion of the tool per motion of the handle, (Kc + Kt)⁺ Kc, for matrices of
// one unit. By the pseudoinverse the tool does not move in directions in which
// nothing holds it.
Mat6 Follow(const Mat6& Kc, const Mat6& Kt) {
  const auto [values, axes] = DecomposeSymmetric(Kc + Kt);
  const double softest = kSoftest * values.maxCoeff();
  Vec6 inverse = Vec6::Zero();
  for (int i = 0; i < 6; ++i) {
    if (values[i] > softest) inverse[i] = 1 / values[i];
  }
  return axes * inverse.asDiagonal() * axes.transpose() * Kc;
}

}  // namespace

HandleSlopes ComputeHandleSlopes(const Vec3& p_HoTo_W,
                                 const WrenchModel& coupling,
                                 const WrenchModel& contact) {
  // Rotations are scaled by a length, so that all entries have one unit.
  Vec6 length;
  length << Vec3::Constant(1 / kHandleLength), Vec3::Ones();
  const auto even = [&length](const Mat6& matrix) -> Mat6 {
    bool changed = false;
    return length.asDiagonal() *
           ProjectToPositiveSemidefinite(matrix, &changed) *
           length.asDiagonal();
  };
  const Mat6 Kc = even(coupling.K), Kt = even(contact.K);
  const Mat6 Bc = even(coupling.B), Bt = even(contact.B);
  const Mat6 G = Follow(Kc, Kt);
  const Mat6 rest = Mat6::Identity() - G;
  // Kc − Kc G, as a sum of two positive semidefinite matrices.
  const Mat6 K = rest.transpose() * Kc * rest + G.transpose() * Kt * G;
  const Mat6 B = rest.transpose() * Bc * rest + G.transpose() * Bt * G;

  // A displacement [θ; p] of the handle at Ho moves its point at To by
  // p + θ × p_HoTo. Rotations are scaled back to rad.
  Mat6 shift = Mat6::Identity();
  shift.bottomLeftCorner<3, 3>() = CrossMatrix<double>(-p_HoTo_W);
  const Mat6 at_handle = length.cwiseInverse().asDiagonal() * shift;
  return {at_handle.transpose() * K * at_handle,
          at_handle.transpose() * B * at_handle};
}

Eigen::Matrix<double, 72, 1> ToVector(const HandleSlopes& slopes) {
  Eigen::Matrix<double, 72, 1> vector;
  vector << slopes.K.reshaped<Eigen::RowMajor>(),
      slopes.B.reshaped<Eigen::RowMajor>();
  return vector;
}

}  // namespace drake_haptics
