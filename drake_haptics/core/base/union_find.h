#pragma once

#include <numeric>
#include <vector>

namespace drake_haptics {

/// Disjoint sets of numbers, each with a root that stands for it (Galler and
/// Fischer 1964).
class UnionFind {
 public:
  /// Starts with each number in a set of its own.
  explicit UnionFind(int count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int Root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Merges the set of `i` into the set of `to`, which keeps its root.
  void Join(int i, int to) { parent_[Root(i)] = Root(to); }

 private:
  std::vector<int> parent_;
};

}  // namespace drake_haptics
