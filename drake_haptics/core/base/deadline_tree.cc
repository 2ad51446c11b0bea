#include "base/deadline_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace drake_haptics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

DeadlineTree::DeadlineTree(int count)
    : leaves_(static_cast<int>(std::bit_ceil(static_cast<unsigned>(count)))),
      times_(2 * leaves_, kNever) {
  for (int i = 0; i < count; ++i) MakeDue(i);
}

void DeadlineTree::Set(int item, double time) {
  assert(item >= 0 && item < leaves_);
  int node = leaves_ + item;
  if (times_[node] == time) return;
  times_[node] = time;
  while (node > 1) {
    node /= 2;
    times_[node] = std::min(times_[2 * node], times_[2 * node + 1]);
  }
}

void DeadlineTree::Collect(double time, std::vector<int>* due) const {
  due->clear();
  Collect(1, time, due);
}

void DeadlineTree::Collect(int node, double time, std::vector<int>* due) const {
  if (times_[node] > time) return;
  if (node >= leaves_) {
    if (times_[node] < kNever) due->push_back(node - leaves_);
    return;
  }
  Collect(2 * node, time, due);
  Collect(2 * node + 1, time, due);
}

}  // namespace drake_haptics
