#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace drake_haptics {

/// The latest value of one writing thread, for any number of reading threads.
/// Neither side waits for the other: a reader that meets a write keeps its old
/// value. It does not retry forever, since a reader of higher priority on the
/// writer's core would then never let the write end.
///
/// The value is stored as atomic words, so that a torn read is detected and
/// discarded instead of being a data race (Boehm, "Can seqlocks get along with
/// programming language memory models?", MSPC 2012).
template <typename T>
class Seqlock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Replaces the value. One thread only.
  void Write(const T& value) {
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t before = version_.load(std::memory_order_relaxed);
    version_.store(before + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < kWords; ++i) {
      words_[i].store(words[i], std::memory_order_relaxed);
    }
    version_.store(before + 2, std::memory_order_release);
  }

  /// Copies the value if it is newer than the one that this reader has.
  /// @param seen version that the reader has, kept by the reader; 0 at first.
  /// @returns whether `value` was replaced.
  bool ReadNewer(std::uint64_t* seen, T* value) const {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const std::uint64_t before = version_.load(std::memory_order_acquire);
      if (before == *seen) return false;
      if (before % 2 == 1) continue;  // a write is under way
      Words words;
      for (std::size_t i = 0; i < kWords; ++i) {
        words[i] = words_[i].load(std::memory_order_relaxed);
      }
      std::atomic_thread_fence(std::memory_order_acquire);
      if (version_.load(std::memory_order_relaxed) != before) continue;
      // As bytes, because default member initializers make T nontrivial.
      std::memcpy(static_cast<void*>(value), words.data(), sizeof(T));
      *seen = before;
      return true;
    }
    return false;
  }

 private:
  static constexpr int kAttempts = 16;
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;

  std::atomic<std::uint64_t> version_{0};  // odd while a write is under way
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace drake_haptics
