// One writer and two readers: nothing torn, nothing old, the last one seen.
// Also runs under the thread sanitizer.
#include "device/seqlock.h"

#include <array>
#include <cstdint>
#include <thread>

#include "check.h"

namespace drake_haptics {
namespace {

// All words follow from the first, so that a torn one is known.
struct Value {
  std::array<std::uint64_t, 37> words;
  std::uint32_t odd_end;  // no whole number of words
};

constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;

Value MakeValue(std::uint64_t count) {
  Value value;
  for (std::size_t i = 0; i < value.words.size(); ++i) {
    value.words[i] = count * kFactor + i;
  }
  value.odd_end = static_cast<std::uint32_t>(count);
  return value;
}

std::uint64_t CountOf(const Value& value) {
  const std::uint64_t first = value.words[0];
  for (std::size_t i = 0; i < value.words.size(); ++i) {
    if (value.words[i] != first + i) return 0;
  }
  const auto inverse = [](std::uint64_t odd) {
    std::uint64_t x = odd;  // Newton's method modulo 2^64
    for (int i = 0; i < 6; ++i) x *= 2 - odd * x;
    return x;
  };
  const std::uint64_t count = first * inverse(kFactor);
  return value.odd_end == static_cast<std::uint32_t>(count) ? count : 0;
}

constexpr std::uint64_t kLast = 200000;

void Watch(const Seqlock<Value>& box, int* num_faults, std::uint64_t* seen) {
  std::uint64_t version = 0, last = 0;
  Value value;
  while (last < kLast) {
    if (!box.ReadNewer(&version, &value)) continue;
    const std::uint64_t count = CountOf(value);
    *num_faults += count <= last;
    ++*seen;
    if (count == 0) return;
    last = count;
  }
}

void ReadersSeeWholeValuesInOrder() {
  Seqlock<Value> box;
  std::array<int, 2> num_faults{};
  std::array<std::uint64_t, 2> seen{};
  std::thread first([&] { Watch(box, &num_faults[0], &seen[0]); });
  std::thread second([&] { Watch(box, &num_faults[1], &seen[1]); });
  for (std::uint64_t count = 1; count <= kLast; ++count) {
    box.Write(MakeValue(count));
  }
  first.join();
  second.join();
  CHECK(num_faults[0] == 0 && num_faults[1] == 0);
  CHECK(seen[0] > 0 && seen[1] > 0);
}

void SaysWhetherThereIsANewOne() {
  Seqlock<Value> box;
  std::uint64_t version = 0;
  Value value = MakeValue(7);
  CHECK(!box.ReadNewer(&version, &value));
  CHECK(CountOf(value) == 7);
  box.Write(MakeValue(8));
  box.Write(MakeValue(9));
  CHECK(box.ReadNewer(&version, &value));
  CHECK(CountOf(value) == 9);
  CHECK(!box.ReadNewer(&version, &value));
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::SaysWhetherThereIsANewOne();
  drake_haptics::ReadersSeeWholeValuesInOrder();
  return drake_haptics::FailedChecks() > 0;
}
