#pragma once

#include <drake_haptics/wire.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <cstdint>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include "bind/bind_eigen.h"
#include "bind/bind_real_array.h"

/// Helpers that the bindings of packets and of the gate share.
namespace drake_haptics {

/// @throws std::invalid_argument unless the value is `size` real numbers.
template <std::size_t size>
void ReadReals(nanobind::handle value, const char* name, double (&out)[size]) {
  const RealArray array(value, name);
  if (array.ndim() != 1 || array.shape(0) != static_cast<Py_ssize_t>(size)) {
    throw std::invalid_argument(std::string(name) + " must be (" +
                                std::to_string(size) + ",); got shape " +
                                array.shape_text());
  }
  for (std::size_t i = 0; i < size; ++i) out[i] = array[i];
}

/// @throws std::invalid_argument unless low <= value <= high.
template <typename Out>
void ReadCount(const char* name, nanobind::int_ value, Out* out,
               std::uint64_t low = 0,
               std::uint64_t high = std::numeric_limits<Out>::max()) {
  std::uint64_t count = 0;
  const bool fits =
      nanobind::try_cast(value, count) && count >= low && count <= high;
  if (!fits) {
    throw std::invalid_argument(
        std::string(name) + " must be from " + std::to_string(low) + " to " +
        std::to_string(high) + ", got " +
        nanobind::cast<std::string>(nanobind::str(value)));
  }
  *out = static_cast<Out>(count);
}

/// A fresh array of the numbers of a member.
template <auto member, typename Class>
auto ArrayOf(const Class& self) {
  constexpr int size = sizeof(self.*member) / sizeof(double);
  return Eigen::Matrix<double, size, 1>(std::data(self.*member));
}

inline const std::uint8_t* Data(const nanobind::bytes& bytes) {
  return static_cast<const std::uint8_t*>(bytes.data());
}

/// Name of a verdict in Python.
inline const char* NameOf(dh_verdict verdict) {
  static constexpr const char* kNames[DH_VERDICT_COUNT] = {
      "accepted",      "too_short",          "wrong_magic",
      "wrong_version", "wrong_kind",         "wrong_size",
      "wrong_crc",     "wrong_field",        "foreign_session",
      "old_sequence",  "not_disabled_first", "at_fault",
      "not_finite",    "clock_went_back"};
  return kNames[verdict];
}

}  // namespace drake_haptics
