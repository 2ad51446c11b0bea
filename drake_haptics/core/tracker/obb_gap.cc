#include "tracker/obb_gap.h"

#include <algorithm>
#include <cmath>

namespace drake_haptics {

ObbGap::ObbGap(const Pose& X_AB) : X_AB_(X_AB), reach_AB_(X_AB.R.cwiseAbs()) {}

double ObbGap::Gap(const Box& a, const Box& b) const {
  const Mat3& R = X_AB_.R;
  const Mat3& reach = reach_AB_;
  const Vec3& p = X_AB_.p;
  const double x = R(0, 0) * b.center.x() + R(0, 1) * b.center.y() +
                   R(0, 2) * b.center.z() + (p.x() - a.center.x());
  const double y = R(1, 0) * b.center.x() + R(1, 1) * b.center.y() +
                   R(1, 2) * b.center.z() + (p.y() - a.center.y());
  const double z = R(2, 0) * b.center.x() + R(2, 1) * b.center.y() +
                   R(2, 2) * b.center.z() + (p.z() - a.center.z());
  double gap = -1e300;
  for (int i = 0; i < 3; ++i) {
    const double c = i == 0 ? x : i == 1 ? y : z;
    gap =
        std::max(gap, std::abs(c) - a.half[i] - reach(i, 0) * b.half.x() -
                          reach(i, 1) * b.half.y() - reach(i, 2) * b.half.z());
  }
  for (int i = 0; i < 3; ++i) {
    const double c = R(0, i) * x + R(1, i) * y + R(2, i) * z;
    gap =
        std::max(gap, std::abs(c) - b.half[i] - reach(0, i) * a.half.x() -
                          reach(1, i) * a.half.y() - reach(2, i) * a.half.z());
  }
  return gap;
}

}  // namespace drake_haptics
