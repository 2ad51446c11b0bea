#include "tracker/piece_bvh.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace drake_haptics {
namespace {

using Node = PieceBvh::Node;

// Neighbors to either side on the space-filling curve that may be merged.
constexpr int kSearchRadius = 16;
// At least one node in this many is merged in a round.
constexpr int kLeastMergedShare = 8;

Node Leaf(const Polytope& piece, int index) {
  Vec3 low = piece.vertices[0], high = low;
  for (const Vec3& v : piece.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  Node node;
  node.box.center = (low + high) / 2;
  node.box.half = (high - low) / 2;
  node.piece = index;
  return node;
}

Node Merge(const Node& p, const Node& q) {
  const Vec3 low =
      (p.box.center - p.box.half).cwiseMin(q.box.center - q.box.half);
  const Vec3 high =
      (p.box.center + p.box.half).cwiseMax(q.box.center + q.box.half);
  Node node;
  node.box.center = (low + high) / 2;
  node.box.half = (high - low) / 2;
  return node;
}

double MergedArea(const Node& p, const Node& q) {
  const Vec3 h = Merge(p, q).box.half;
  return h.x() * h.y() + h.y() * h.z() + h.z() * h.x();
}

// Spreads the low 21 bits of x to every third bit.
std::uint64_t Spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

// Position on the Morton curve through the given box.
std::uint64_t CurveKey(const Vec3& p, const Vec3& low, const Vec3& size) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) {
    const double share = size[i] > 0 ? (p[i] - low[i]) / size[i] : 0.0;
    const auto cell = static_cast<std::uint64_t>(share * 0x1fffff);
    key |= Spread(cell) << i;
  }
  return key;
}

// Indices of the leaves in the order of the curve.
std::vector<int> CurveOrder(const std::vector<Node>& leaves) {
  Vec3 low = leaves[0].box.center, high = low;
  for (const Node& leaf : leaves) {
    low = low.cwiseMin(leaf.box.center);
    high = high.cwiseMax(leaf.box.center);
  }
  std::vector<std::uint64_t> keys;
  for (const Node& leaf : leaves) {
    keys.push_back(CurveKey(leaf.box.center, low, high - low));
  }
  std::vector<int> order(leaves.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&keys](int i, int j) { return keys[i] < keys[j]; });
  return order;
}

// Returns for each active node its best partner nearby on the curve. The best
// pair of all chose each other: among ties a node takes the partner with the
// smallest XOR of their places, which differs for all partners.
std::vector<int> BestPartners(const std::vector<Node>& nodes,
                              const std::vector<int>& active) {
  const int count = static_cast<int>(active.size());
  std::vector<int> partner(count, -1);
  for (int i = 0; i < count; ++i) {
    std::pair best{std::numeric_limits<double>::infinity(),
                   std::numeric_limits<int>::max()};
    for (int j = std::max(0, i - kSearchRadius);
         j <= std::min(count - 1, i + kSearchRadius); ++j) {
      if (j == i) continue;
      const std::pair fit{MergedArea(nodes[active[i]], nodes[active[j]]),
                          i ^ j};
      if (fit < best) {
        best = fit;
        partner[i] = j;
      }
    }
  }
  return partner;
}

// One round of merging: pairs that chose each other become one node. If these
// are few, as in a row with ever wider gaps, neighbors on the curve are merged
// instead, so that the depth is logarithmic in the number of leaves.
std::vector<int> MergeRound(const std::vector<int>& active,
                            std::vector<Node>* nodes) {
  const int count = static_cast<int>(active.size());
  std::vector<int> partner = BestPartners(*nodes, active);
  int mutual = 0;
  for (int i = 0; i < count; ++i) mutual += partner[partner[i]] == i;
  if (mutual * kLeastMergedShare < count) {
    for (int i = 0; i < count; ++i) partner[i] = std::min(i ^ 1, count - 1);
  }
  std::vector<int> next;
  for (int i = 0; i < count; ++i) {
    const int j = partner[i];
    if (j == i || partner[j] != i) {
      next.push_back(active[i]);
    } else if (i < j) {
      Node node = Merge((*nodes)[active[i]], (*nodes)[active[j]]);
      node.left = active[i];
      node.right = active[j];
      nodes->push_back(node);
      next.push_back(static_cast<int>(nodes->size()) - 1);
    }
  }
  return next;
}

}  // namespace

PieceBvh::PieceBvh(std::span<const Polytope> pieces) {
  if (pieces.empty()) return;
  std::vector<Node> leaves;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    leaves.push_back(Leaf(pieces[i], static_cast<int>(i)));
  }
  nodes_.reserve(2 * leaves.size());
  leaf_of_.resize(leaves.size());
  for (const int i : CurveOrder(leaves)) {
    leaf_of_[i] = static_cast<int>(nodes_.size());
    nodes_.push_back(leaves[i]);
  }
  std::vector<int> active(nodes_.size());
  std::iota(active.begin(), active.end(), 0);
  while (active.size() > 1) active = MergeRound(active, &nodes_);
}

}  // namespace drake_haptics
