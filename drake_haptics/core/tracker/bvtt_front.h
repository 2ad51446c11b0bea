#pragma once

#include <limits>
#include <vector>

#include "tracker/obb_gap.h"
#include "tracker/piece_bvh.h"

namespace drake_haptics {

/// Two pieces, one of each body.
struct PiecePair {
  int a = 0;
  int b = 0;
  auto operator<=>(const PiecePair&) const = default;
};

/// A pair of pieces whose boxes have come within reach of each other.
struct EnteredPair {
  PiecePair pieces;
  int node = 0;    ///< its node in the front
  double gap = 0;  ///< between the boxes, m
};

/// Front of a simultaneous descent through two trees, kept between ticks
/// (generalized front tracking; Ehmann and Lin 2001): the pairs of nodes above
/// the front are within reach of each other, those on it are apart or are
/// leaves within reach.
///
/// Distances refer to an odometer, which adds up the motion of A in B. A pair
/// of nodes that is apart by a gap g at odometer value s stays apart while the
/// odometer is below its mark s + g, and is not visited until then; nor is a
/// branch of the front before its smallest mark. So the cost of a tick depends
/// on the motion since the last one, not on the size of the bodies.
class BvttFront {
 public:
  struct Tick {
    const PieceBvh& A;
    const PieceBvh& B;
    const ObbGap& boxes;  ///< at the present pose
    double odometer;      ///< m
    double reach;         ///< largest gap of a pair within reach, m
  };

  /// Moves the front to the tick's pose and appends the pairs of leaves that
  /// have come within reach. The caller keeps them until it returns them.
  void Advance(const Tick& tick, std::vector<EnteredPair>* entered);

  /// Puts back a pair of leaves that has gone out of reach.
  void Return(int node, double gap, double odometer);

  /// Odometer up to which no pair on the front can touch, m.
  double mark() const { return nodes_.empty() ? kNever : nodes_[0].mark; }

  void Clear() {
    nodes_.clear();
    free_.clear();
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  // A pair of nodes, one of each tree. Its two children are adjacent.
  struct Node {
    int a, b;
    int parent;
    int children = -1;
    double mark = -kNever;  // smallest on the front below
  };

  double Visit(int i, const Tick& tick, std::vector<EnteredPair>* entered);
  double VisitFront(int i, const Tick& tick, std::vector<EnteredPair>* entered);
  void Split(int i, const Tick& tick);
  void Merge(int i, const Tick& tick);

  std::vector<Node> nodes_;  // the first is the root
  std::vector<int> free_;    // first of two adjacent unused nodes
};

}  // namespace drake_haptics
