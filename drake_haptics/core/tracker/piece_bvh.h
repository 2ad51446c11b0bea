#pragma once

#include <span>
#include <vector>

#include "convex/polytope.h"
#include "tracker/obb_gap.h"

namespace drake_haptics {

/// A bounding volume hierarchy over the pieces of an object, built bottom-up
/// as in the paper (section 3). Inner nodes hold boxes that contain the hulls
/// below them: a box test costs a few instructions where a hull would cost a
/// distance query. Immutable, so that objects of one shape share it.
class PieceBvh {
 public:
  struct Node {
    Box box;        ///< in the object's frame
    int left = -1;  ///< children; -1 in a leaf
    int right = -1;
    int piece = -1;  ///< in a leaf

    bool is_leaf() const { return piece >= 0; }
  };

  PieceBvh() = default;
  explicit PieceBvh(std::span<const Polytope> pieces);

  bool empty() const { return nodes_.empty(); }
  int root() const { return static_cast<int>(nodes_.size()) - 1; }
  const Node& node(int i) const { return nodes_[i]; }
  /// Box around all pieces, without extent if there are none.
  Box bounds() const { return empty() ? Box() : nodes_.back().box; }
  const Box& box_of(int piece) const { return nodes_[leaf_of_[piece]].box; }

 private:
  std::vector<Node> nodes_;
  std::vector<int> leaf_of_;  // of each piece
};

}  // namespace drake_haptics
