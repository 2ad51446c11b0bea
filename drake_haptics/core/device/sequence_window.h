#pragma once

#include <cstdint>

namespace drake_haptics {

/// Tracks which packets of a numbered series came, in what order, and which are
/// lost. Numbers rise by one and wrap at 2³²; they are compared by
/// serial-number arithmetic (RFC 1982).
class SequenceWindow {
 public:
  enum class Arrival { kNewest, kLate, kDuplicate };

  /// Counts a packet. A packet that is 64 numbers late or more counts as a
  /// duplicate.
  Arrival Accept(std::uint32_t sequence);

  /// Numbers that were skipped and have not come since.
  std::int64_t num_lost() const { return num_lost_; }
  std::int64_t num_late() const { return num_late_; }
  std::int64_t num_duplicate() const { return num_duplicate_; }

  /// Begins a new series; the counts go on.
  void Restart() { has_newest_ = false; }

 private:
  bool has_newest_ = false;
  std::uint32_t newest_ = 0;
  std::uint64_t came_ = 0;  // bit i: newest_ - i has come
  std::int64_t num_lost_ = 0;
  std::int64_t num_late_ = 0;
  std::int64_t num_duplicate_ = 0;
};

}  // namespace drake_haptics
