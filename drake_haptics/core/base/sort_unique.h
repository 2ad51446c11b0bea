#pragma once

#include <algorithm>
#include <vector>

namespace drake_haptics {

/// Sorts items and removes those that are equal to an earlier one.
template <typename Item>
void SortUnique(std::vector<Item>* items) {
  std::sort(items->begin(), items->end());
  items->erase(std::unique(items->begin(), items->end()), items->end());
}

}  // namespace drake_haptics
