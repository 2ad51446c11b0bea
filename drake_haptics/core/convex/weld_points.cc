#include "convex/weld_points.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace drake_haptics {
namespace {

// Points on a lattice or in a plane do not coincide along this direction.
const Vec3 kOblique = Vec3(0.8034271, 0.5119483, 0.3042617).normalized();

// Indices of distinct points, the first of equal ones, ascending.
std::vector<int> UnequalPoints(std::span<const Vec3> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3& p = points[i];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return std::tuple(key(i), i) < std::tuple(key(j), j);
  });
  const auto last = std::unique(order.begin(), order.end(), [&](int i, int j) {
    return points[i] == points[j];
  });
  order.erase(last, order.end());
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<int> WeldPoints(std::span<const Vec3> points, double distance) {
  std::vector<int> kept = UnequalPoints(points);
  std::vector<std::pair<double, int>> along;
  along.reserve(kept.size());
  for (const int i : kept) along.emplace_back(kOblique.dot(points[i]), i);
  std::sort(along.begin(), along.end());
  // Pairs (later, earlier): in sorted order, the earlier one is decided first.
  std::vector<std::pair<int, int>> close;
  for (std::size_t k = 0; k < along.size(); ++k) {
    const auto& [height, i] = along[k];
    for (std::size_t l = k + 1;
         l < along.size() && along[l].first - height <= distance; ++l) {
      const int j = along[l].second;
      if ((points[i] - points[j]).norm() <= distance) {
        close.emplace_back(std::max(i, j), std::min(i, j));
      }
    }
  }
  if (close.empty()) return kept;
  std::sort(close.begin(), close.end());
  std::vector<std::uint8_t> dropped(points.size(), 0);
  for (const auto& [later, earlier] : close) {
    if (!dropped[earlier]) dropped[later] = 1;
  }
  std::erase_if(kept, [&](int i) { return dropped[i] != 0; });
  return kept;
}

}  // namespace drake_haptics
