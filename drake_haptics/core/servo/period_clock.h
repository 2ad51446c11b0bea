#pragma once

#include <cstdint>

namespace drake_haptics {

/// Due times of turns at a fixed rate. Time is an argument. A late turn is
/// counted and not made up for, so that there are no bursts.
class PeriodClock {
 public:
  /// @param period s, above zero.
  explicit PeriodClock(double period) : period_(period) {}

  /// Ends a turn at `now`, s.
  /// @returns time until the next turn is due, s; 0 if it is due now or late.
  double EndTurn(double now) {
    const bool is_late = has_begun_ && now > due_ + period_;
    num_late_ += is_late;
    due_ = has_begun_ && !is_late ? due_ + period_ : now;
    has_begun_ = true;
    return due_ - now;
  }

  /// Number of turns that took longer than a period.
  std::int64_t num_late() const { return num_late_; }

 private:
  double period_;
  double due_ = 0;
  bool has_begun_ = false;
  std::int64_t num_late_ = 0;
};

}  // namespace drake_haptics
