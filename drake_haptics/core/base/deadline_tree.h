#pragma once

#include <limits>
#include <vector>

namespace drake_haptics {

/// Times at which items are due, as a tree of minima: items that are not due
/// cost nothing.
class DeadlineTree {
 public:
  /// Starts with all items due.
  explicit DeadlineTree(int count);

  void Set(int item, double time);

  /// Makes the item due at once.
  void MakeDue(int item) {
    Set(item, -std::numeric_limits<double>::infinity());
  }

  /// Writes the items that are due at `time` to `due`, in ascending order.
  void Collect(double time, std::vector<int>* due) const;

 private:
  void Collect(int node, double time, std::vector<int>* due) const;

  int leaves_;                 // a power of two
  std::vector<double> times_;  // node i: the minimum of nodes 2 i and 2 i + 1
};

}  // namespace drake_haptics
