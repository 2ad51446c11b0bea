#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace drake_haptics::fuzz {

/// Turns the bytes of a fuzzer into choices and numbers. Spent bytes read as
/// zero, so that every input is a valid one and short inputs stay simple.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool is_spent() const { return next_ >= bytes_.size(); }

  std::uint8_t Byte() { return is_spent() ? 0 : bytes_[next_++]; }

  /// In [0, count).
  int Choice(int count) { return Byte() % count; }

  bool Flag() { return Choice(2) == 1; }

  /// True once in `odds` times.
  bool Rarely(int odds) { return Choice(odds) == 1; }

  /// In [-1, 1], in 65,536 steps; 0 for zero bytes.
  double Unit() {
    const int low = Byte(), high = Byte();
    return static_cast<std::int16_t>(low | high << 8) / 32768.0;
  }

  /// A power of ten with an exponent between the given ones.
  double Power(int lowest, int highest) {
    return std::pow(10.0, lowest + Choice(highest - lowest + 1));
  }

  /// Any bits: NaN, infinity and denormals among them.
  double AnyDouble() {
    std::uint8_t bits[sizeof(double)];
    for (std::uint8_t& byte : bits) byte = Byte();
    double value;
    std::memcpy(&value, bits, sizeof value);
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
};

}  // namespace drake_haptics::fuzz
