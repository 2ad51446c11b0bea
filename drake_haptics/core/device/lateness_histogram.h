#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace drake_haptics {

/// Histogram of a thread's lateness over powers of 2^(1/4), from 1 µs to over
/// 10 s, so that each value is known within a fifth. One thread records, any
/// other reads.
class LatenessHistogram {
 public:
  /// Counts one lateness, s. Less than 1 µs counts as 1 µs.
  void Record(double lateness);

  /// Upper bound on the lateness (s) that the given part of all records did not
  /// exceed; 0 without records.
  double Quantile(double part) const;

 private:
  static constexpr int kPerOctave = 4;
  static constexpr int kBuckets = 24 * kPerOctave;
  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
};

/// Lateness of the answers to samples, relative to the promptest recent answer.
/// It compares the clock of the sender's stamps with ours, whose offset is
/// unknown and drifts: the smallest difference of the last 10 to 20 s counts as
/// no lateness.
class AnswerLateness {
 public:
  /// @param stamp time of the sample by the sender's clock, s.
  /// @param now time of the answer by our clock, s.
  /// @returns the lateness, s, at least 0.
  double Measure(double stamp, double now);

  /// Forgets the sender's clock.
  void Restart() { has_any_ = false; }

 private:
  bool has_any_ = false;
  double window_began_ = 0;
  double smallest_ = 0;         // smallest difference in this window
  double smallest_before_ = 0;  // and in the window before
};

}  // namespace drake_haptics
