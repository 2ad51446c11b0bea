#include "device/lateness_histogram.h"

#include <algorithm>
#include <cmath>

namespace drake_haptics {
namespace {

constexpr double kSmallest = 1e-6;  // s
constexpr double kWindow = 10;      // s

}  // namespace

void LatenessHistogram::Record(double lateness) {
  const double octaves = std::log2(std::max(lateness, kSmallest) / kSmallest);
  // NaN counts as the largest lateness.
  const bool is_within = kPerOctave * octaves < kBuckets - 1;
  const int bucket =
      is_within ? static_cast<int>(kPerOctave * octaves) : kBuckets - 1;
  counts_[bucket].fetch_add(1, std::memory_order_relaxed);
}

double LatenessHistogram::Quantile(double part) const {
  std::array<std::uint64_t, kBuckets> counts;
  std::uint64_t total = 0;
  for (int i = 0; i < kBuckets; ++i) {
    counts[i] = counts_[i].load(std::memory_order_relaxed);
    total += counts[i];
  }
  if (total == 0) return 0;
  const double wanted = part * static_cast<double>(total);
  std::uint64_t below = 0;
  int bucket = 0;
  for (; bucket < kBuckets - 1; ++bucket) {
    below += counts[bucket];
    if (static_cast<double>(below) >= wanted) break;
  }
  return kSmallest * std::exp2((bucket + 1.0) / kPerOctave);
}

double AnswerLateness::Measure(double stamp, double now) {
  const double difference = now - stamp;
  if (!has_any_) {
    has_any_ = true;
    window_began_ = now;
    smallest_ = smallest_before_ = difference;
  } else if (now - window_began_ > kWindow) {
    window_began_ = now;
    smallest_before_ = smallest_;
    smallest_ = difference;
  }
  smallest_ = std::min(smallest_, difference);
  return difference - std::min(smallest_, smallest_before_);
}

}  // namespace drake_haptics
