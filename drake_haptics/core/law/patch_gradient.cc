#include "law/patch_gradient.h"

#include <algorithm>
#include <cstdlib>

#include "base/rotation.h"
#include "pair/contact_patch.h"

namespace drake_haptics {
namespace {

// Step of the differences, as a share of the layer.
constexpr double kStepShare = 1e-4;
// Of fourth order: weights of one step and of two.
constexpr double kNear = 2.0 / 3, kFar = -1.0 / 12;

}  // namespace

void DifferentiatePatch(const PosedPieces& pieces, const Contact& contact,
                        double tolerance, ContactGradient* gradient,
                        MovingWitness* witness) {
  const double layer = PressureLayer(tolerance);
  const MinkowskiVertex vertex_pair{contact.support[0], contact.support[1]};
  const MovingWitness of_features = *witness;
  PatchWorkspace workspace;
  // In A's frame, with the tool displaced by `by`.
  const auto patch_at = [&](const Vec6& by) {
    const Mat3 R_WA =
        RotationExp<double>(by.head<3>()).toRotationMatrix() * pieces.X_WA.R;
    const Mat3 R_AW = R_WA.transpose();
    const Vec3 p_ToBo = pieces.X_WB.p - pieces.X_WA.p - by.tail<3>();
    const PosedPair pair{
        pieces.A, pieces.B, {R_AW * pieces.X_WB.R, R_AW * p_ToBo}};
    const Vec3 n = (contact.nhat_BA_W + gradient->nhat_BA_W * by).normalized();
    const double h = contact.distance + gradient->distance.dot(by);
    const Vec3 p_a = of_features.p + of_features.motion * by - by.tail<3>();
    PressurePatch patch = FindPressurePatch(
        pair, R_AW * n, h, vertex_pair, R_AW * p_a,
        std::clamp(tolerance - h, 0.0, layer), layer, &workspace);
    patch.center = R_WA * patch.center.value_or(R_AW * p_a) + by.tail<3>();
    return patch;
  };
  const double step = kStepShare * layer;
  // A turn moves the outline of a piece, however near to To it is.
  const double arm = std::max(
      {of_features.p.norm(), pieces.A.radius + pieces.B.radius, layer});
  witness->p = *patch_at(Vec6::Zero()).center;
  Mat36 motion = Mat36::Zero();
  for (int k = 0; k < 6; ++k) {
    const double by = k < 3 ? step / arm : step;
    for (const int times : {-2, -1, 1, 2}) {
      const PressurePatch patch = patch_at(times * by * Vec6::Unit(k));
      const double weight =
          (std::abs(times) == 1 ? kNear : kFar) * (times > 0 ? 1 : -1) / by;
      gradient->extent[k] += weight * patch.extent;
      gradient->flushness[k] += weight * patch.flushness;
      motion.col(k) += weight * (*patch.center - witness->p);
    }
  }
  witness->motion = motion;
}

}  // namespace drake_haptics
