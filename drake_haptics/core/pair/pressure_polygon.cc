#include "pair/pressure_polygon.h"

#include <cmath>

namespace drake_haptics {

std::optional<Load> PressureLoad(const std::vector<Vec3>& corners) {
  double total = 0;
  Vec3 moment = Vec3::Zero();
  if (corners.size() == 2) {
    const Vec3 &p = corners[0], &q = corners[1];
    const double length = (q - p).head<2>().norm();
    total = length / 2 * (p.z() + q.z());
    moment = length / 6 * (p * (2 * p.z() + q.z()) + q * (p.z() + 2 * q.z()));
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3 &p = corners[0], &q = corners[i], &r = corners[i + 1];
    const double area =
        std::abs((q - p).x() * (r - p).y() - (q - p).y() * (r - p).x()) / 2;
    const double sum = p.z() + q.z() + r.z();
    total += area * sum / 3;
    moment +=
        area / 12 * (p * (sum + p.z()) + q * (sum + q.z()) + r * (sum + r.z()));
  }
  if (!(total > 0)) return std::nullopt;
  return Load{moment / total, total};
}

}  // namespace drake_haptics
