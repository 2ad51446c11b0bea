#include "tracker/bvtt_front.h"

#include <algorithm>

namespace drake_haptics {
namespace {

// Two pairs of nodes are merged if their parent pair stays out of reach for at
// least this share of the motion that they do.
constexpr double kMergeShare = 0.5;

double Size(const Box& box) { return box.half.sum(); }

double GapOf(const BvttFront::Tick& tick, int a, int b) {
  return tick.boxes.Gap(tick.A.node(a).box, tick.B.node(b).box);
}

}  // namespace

void BvttFront::Advance(const Tick& tick, std::vector<EnteredPair>* entered) {
  if (tick.A.empty() || tick.B.empty()) return;
  if (nodes_.empty()) nodes_.push_back({tick.A.root(), tick.B.root(), -1});
  if (nodes_[0].mark <= tick.odometer + tick.reach) Visit(0, tick, entered);
}

// Visits a node whose mark is reached. Returns its new mark.
double BvttFront::Visit(int i, const Tick& tick,
                        std::vector<EnteredPair>* entered) {
  const double due = tick.odometer + tick.reach;
  if (nodes_[i].children < 0) {
    const double mark = VisitFront(i, tick, entered);
    nodes_[i].mark = mark;
    if (nodes_[i].children < 0) return mark;
  }
  const int children = nodes_[i].children;
  double left = nodes_[children].mark;
  if (left <= due) left = Visit(children, tick, entered);
  double right = nodes_[children + 1].mark;
  if (right <= due) right = Visit(children + 1, tick, entered);
  nodes_[i].mark = std::min(left, right);
  if (nodes_[i].mark > due && std::max(left, right) < kNever &&
      nodes_[children].children < 0 && nodes_[children + 1].children < 0) {
    Merge(i, tick);
  }
  return nodes_[i].mark;
}

// Visits a pair on the front whose mark is reached: it is still apart, or two
// leaves within reach, or is split. Returns its new mark.
double BvttFront::VisitFront(int i, const Tick& tick,
                             std::vector<EnteredPair>* entered) {
  const int a = nodes_[i].a, b = nodes_[i].b;
  const double gap = GapOf(tick, a, b);
  if (gap > tick.reach) return tick.odometer + gap;
  const PieceBvh::Node& node_a = tick.A.node(a);
  const PieceBvh::Node& node_b = tick.B.node(b);
  if (node_a.is_leaf() && node_b.is_leaf()) {
    entered->push_back({{node_a.piece, node_b.piece}, i, gap});
    return kNever;
  }
  Split(i, tick);
  return -kNever;
}

void BvttFront::Split(int i, const Tick& tick) {
  int children;
  if (free_.empty()) {
    children = static_cast<int>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
  } else {
    children = free_.back();
    free_.pop_back();
  }
  Node& node = nodes_[i];
  node.children = children;
  const PieceBvh::Node& a = tick.A.node(node.a);
  const PieceBvh::Node& b = tick.B.node(node.b);
  if (b.is_leaf() || (!a.is_leaf() && Size(a.box) >= Size(b.box))) {
    nodes_[children] = {a.left, node.b, i};
    nodes_[children + 1] = {a.right, node.b, i};
  } else {
    nodes_[children] = {node.a, b.left, i};
    nodes_[children + 1] = {node.a, b.right, i};
  }
}

// Replaces two pairs that are both apart by their parent pair, if that stays
// apart for long enough.
void BvttFront::Merge(int i, const Tick& tick) {
  const Node node = nodes_[i];
  const double slack = node.mark - tick.odometer - tick.reach;
  const double gap = GapOf(tick, node.a, node.b);
  if (gap - tick.reach < kMergeShare * slack) return;
  free_.push_back(node.children);
  nodes_[i].children = -1;
  nodes_[i].mark = tick.odometer + gap;
}

void BvttFront::Return(int node, double gap, double odometer) {
  const double mark = odometer + gap;
  for (int i = node; i >= 0 && nodes_[i].mark > mark; i = nodes_[i].parent) {
    nodes_[i].mark = mark;
  }
}

}  // namespace drake_haptics
