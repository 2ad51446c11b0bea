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
  int node = 0;    ///< by which the front knows it
  double gap = 0;  ///< of the boxes, m
};

/// The front of a descent through two trees at once, kept between ticks
/// (generalized front tracking; Ehmann and Lin 2001): all pairs of nodes above
/// it are within reach of each other, the pairs on it are apart, or leaves
/// within reach.
///
/// Distances are told against an odometer, which counts the motion of A in B. A
/// pair of nodes apart by a gap g when the odometer stood at s is apart for as
/// long as the odometer is below s + g: nothing is asked of it until then, nor
/// of any branch of the front whose smallest such mark is not reached. So a
/// tick costs by the motion since the last one, not by the size of the bodies.
class BvttFront {
 public:
  struct Tick {
    const PieceBvh& A;
    const PieceBvh& B;
    const ObbGap& boxes;  ///< at the present pose
    double odometer;      ///< m
    double reach;         ///< pairs with gaps up to this are wanted, m
  };

  /// Moves the front to the tick's pose and appends the pairs of leaves that
  /// have come within reach. These are the caller's, until it returns them.
  void Advance(const Tick& tick, std::vector<EnteredPair>* entered);

  /// Puts back a pair of leaves that has gone out of reach.
  void Return(int node, double gap, double odometer);

  /// Up to where the odometer may go before a pair comes within no reach, m.
  double mark() const { return nodes_.empty() ? kNever : nodes_[0].mark; }

  void Clear() {
    nodes_.clear();
    free_.clear();
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  // A pair of nodes, one of each tree. The two below it are neighbors.
  struct Node {
    int a, b;
    int parent;
    int children = -1;
    double mark = -kNever;  // smallest of the front below it
  };

  double Visit(int i, const Tick& tick, std::vector<EnteredPair>* entered);
  double VisitFront(int i, const Tick& tick, std::vector<EnteredPair>* entered);
  void Split(int i, const Tick& tick);
  void Merge(int i, const Tick& tick);

  std::vector<Node> nodes_;  // the first is the root
  std::vector<int> free_;    // first of two neighbors not in use
};

}  // namespace drake_haptics
