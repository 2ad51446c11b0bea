#include "convex/convex_polygon.h"

#include <algorithm>
#include <numeric>

#include "convex/predicates.h"

namespace drake_haptics {

std::vector<int> ExactConvexPolygon(std::span<const Eigen::Vector2d> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Eigen::Vector2d &p = points[i], &q = points[j];
    if (p.x() != q.x()) return p.x() < q.x();
    return p.y() != q.y() ? p.y() < q.y() : i < j;
  });
  std::vector<int> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= start + 2 &&
             Orient2d(points[hull[hull.size() - 2]], points[hull.back()],
                      points[*it]) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*it);
    }
    hull.pop_back();  // It starts the other chain.
  };
  add_chain(order.begin(), order.end());
  add_chain(order.rbegin(), order.rend());
  return hull;
}

}  // namespace drake_haptics
