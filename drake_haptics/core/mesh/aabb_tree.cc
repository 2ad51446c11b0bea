#include "mesh/aabb_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace drake_haptics {

AabbTree::AabbTree(std::vector<Box> item_boxes)
    : item_boxes_(std::move(item_boxes)), order_(item_boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (order_.empty()) return;
  nodes_.emplace_back();
  Build(0, 0, static_cast<int>(order_.size()));
}

std::vector<AabbTree::Box> TriangleBoxes(std::span<const Vec3> vertices,
                                         std::span<const Triangle> triangles) {
  std::vector<AabbTree::Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t]) boxes[t].extend(vertices[v]);
  }
  return boxes;
}

// Splits at the median of the longest axis: depth is logarithmic for any input.
void AabbTree::Build(int node, int begin, int end) {
  constexpr int kLeafSize = 4;
  for (int i = begin; i < end; ++i) {
    nodes_[node].box.extend(item_boxes_[order_[i]]);
  }
  if (end - begin <= kLeafSize) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  int axis = 0;
  nodes_[node].box.sizes().maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle,
                   order_.begin() + end, [&](int i, int j) {
                     const double p = item_boxes_[i].center()[axis];
                     const double q = item_boxes_[j].center()[axis];
                     return p != q ? p < q : i < j;
                   });
  const int first = static_cast<int>(nodes_.size());
  nodes_[node].first = first;
  nodes_.resize(nodes_.size() + 2);
  Build(first, begin, middle);
  Build(first + 1, middle, end);
}

}  // namespace drake_haptics
