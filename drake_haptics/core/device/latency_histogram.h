#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace drake_haptics {

/// How late a thread was, as a histogram over powers of 2^(1/4): from 1 µs to
/// over 10 s, each within a fifth. One thread records, any other asks.
class LatenessHistogram {
 public:
  /// Counts one lateness, s. Less than 1 µs counts as 1 µs.
  void Record(double lateness);

  /// The lateness (s) that the given part of all records did not exceed, from
  /// above: 0 if there are none.
  double Quantile(double part) const;

 private:
  static constexpr int kPerOctave = 4;
  static constexpr int kBuckets = 24 * kPerOctave;
  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
};

/// How late samples are answered, against the promptest answer of late. Two
/// clocks are compared whose offset is unknown and drifts: that of the sender's
/// stamps and ours. The smallest difference of the last 10 to 20 s is taken for
/// no lateness.
class AnswerLateness {
 public:
  /// @param stamp when the sender sampled, s, by its clock.
  /// @param now when we answered, s, by ours.
  /// @returns the lateness, s, at least 0.
  double Measure(double stamp, double now);

  /// Forgets the sender's clock.
  void Restart() { has_any_ = false; }

 private:
  bool has_any_ = false;
  double window_began_ = 0;
  double smallest_ = 0;         // of this window
  double smallest_before_ = 0;  // of the window before
};

}  // namespace drake_haptics
