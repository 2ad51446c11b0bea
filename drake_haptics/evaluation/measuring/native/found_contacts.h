#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "pair_timing.h"

namespace bench {

/// A contact as another library found it, in the world.
struct FoundContact {
  double distance;      ///< m; negative in depth
  double nhat_BA_W[3];  ///< out of the object into the tool
  double p_WCa[3];      ///< on the tool, m
  double p_WCb[3];      ///< on the object, m
  double object;        ///< its index
};
inline constexpr int kContactSize = sizeof(FoundContact) / sizeof(double);

/// The contacts of many ticks, tick after tick.
struct FoundContacts {
  std::vector<FoundContact> contacts;
  std::vector<int> start{0};

  void EndTick() { start.push_back(static_cast<int>(contacts.size())); }

  /// Copies `start` (ticks + 1) and the contacts, kContactSize numbers each.
  void Copy(int* starts, double* rows) const {
    std::copy(start.begin(), start.end(), starts);
    const auto* numbers = reinterpret_cast<const double*>(contacts.data());
    std::copy_n(numbers, contacts.size() * kContactSize, rows);
  }
};

}  // namespace bench
