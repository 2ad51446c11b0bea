#pragma once

#include <span>
#include <vector>

#include "polytope.h"
#include "types.h"

namespace drake_haptics {

/// A bounding volume hierarchy over the pieces of an object, built bottom-up
/// as in the paper (section 3). Inner nodes hold boxes that contain the hulls
/// below them: a box test costs a few instructions where a hull would cost a
/// distance query.
class PieceTree {
 public:
  struct Node {
    Vec3 center = Vec3::Zero();  ///< of the box, m, in the object's frame
    Vec3 half = Vec3::Zero();    ///< half extents, m
    int left = -1;               ///< children; -1 in a leaf
    int right = -1;
    int piece = -1;  ///< in a leaf

    bool is_leaf() const { return piece >= 0; }
  };

  PieceTree() = default;
  explicit PieceTree(std::span<const Polytope> pieces);

  bool empty() const { return nodes_.empty(); }
  int root() const { return static_cast<int>(nodes_.size()) - 1; }
  const Node& node(int i) const { return nodes_[i]; }

 private:
  std::vector<Node> nodes_;
};

/// Two pieces whose boxes are within reach of each other.
struct PiecePair {
  int a;
  int b;
  auto operator<=>(const PiecePair&) const = default;
};

/// Appends to `pairs` all pairs of leaves whose boxes may be within
/// `tolerance` (m), by descending both trees at once. `stack` is a buffer.
void CollectPairs(const PieceTree& A, const PieceTree& B, const Pose& X_AB,
                  double tolerance, std::vector<PiecePair>* stack,
                  std::vector<PiecePair>* pairs);

}  // namespace drake_haptics
