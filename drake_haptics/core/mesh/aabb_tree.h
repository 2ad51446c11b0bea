#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mesh/decomposition.h"

namespace drake_haptics {

/// Tree of bounding boxes of items, for overlap and nearest-point queries.
class AabbTree {
 public:
  using Box = Eigen::AlignedBox3d;

  explicit AabbTree(std::vector<Box> item_boxes);

  /// Calls `visit(item)` for items whose boxes are nearer to `point` than the
  /// squared distance, m², that the previous call returned. Nearer boxes tend
  /// to come first.
  template <typename Visit>
  void VisitNear(const Eigen::Vector3d& point, const Visit& visit) const {
    double limit = std::numeric_limits<double>::infinity();
    if (!nodes_.empty()) VisitNear(0, point, visit, &limit);
  }

  /// Calls `visit(item)` for each item whose box meets `box`, until one call
  /// returns true. Returns whether one did.
  template <typename Visit>
  bool AnyOverlap(const Box& box, const Visit& visit) const {
    return !nodes_.empty() && AnyOverlap(0, box, visit);
  }

 private:
  // Children of inner nodes are `first` and `first + 1`; a leaf has the items
  // order_[first .. first + count).
  struct Node {
    Box box;
    int first = 0;
    int count = 0;
  };

  void Build(int node, int begin, int end);

  template <typename Visit>
  bool AnyOverlap(int index, const Box& box, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (!node.box.intersects(box)) return false;
    if (node.count == 0) {
      return AnyOverlap(node.first, box, visit) ||
             AnyOverlap(node.first + 1, box, visit);
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int item = order_[i];
      if (item_boxes_[item].intersects(box) && visit(item)) return true;
    }
    return false;
  }

  template <typename Visit>
  void VisitNear(int index, const Eigen::Vector3d& point, const Visit& visit,
                 double* limit) const {
    const Node& node = nodes_[index];
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int item = order_[i];
      if (item_boxes_[item].squaredExteriorDistance(point) < *limit) {
        *limit = visit(item);
      }
    }
    if (node.count > 0) return;
    int near = node.first, far = node.first + 1;
    double near_squared = nodes_[near].box.squaredExteriorDistance(point);
    double far_squared = nodes_[far].box.squaredExteriorDistance(point);
    if (far_squared < near_squared) {
      std::swap(near, far);
      std::swap(near_squared, far_squared);
    }
    if (near_squared < *limit) VisitNear(near, point, visit, limit);
    if (far_squared < *limit) VisitNear(far, point, visit, limit);
  }

  std::vector<Box> item_boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

/// The boxes of triangles, in their order.
std::vector<AabbTree::Box> TriangleBoxes(std::span<const Vec3> vertices,
                                         std::span<const Triangle> triangles);

}  // namespace drake_haptics
