#pragma once

#include <limits>
#include <vector>

namespace drake_haptics {

/// When each of many items wants to be looked at again. A tree of minima: what
/// is not due costs nothing.
class DeadlineTree {
 public:
  /// All items are due.
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
  std::vector<double> times_;  // of node i: the earliest of 2 i and 2 i + 1
};

}  // namespace drake_haptics
