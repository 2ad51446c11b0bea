#pragma once

#include <nanobind/nanobind.h>

#include <cstring>
#include <optional>
#include <string>

/// Numbers that Python passes in, with errors that name the argument.
namespace drake_haptics {

/// Real numbers in an array of Python. NumPy arrays of doubles are read in
/// place, whatever their strides; NumPy converts anything else once. The view
/// is for use within one call, while the GIL is held.
class RealArray {
 public:
  /// @param name the argument, for messages.
  /// @throws std::invalid_argument unless the value holds real numbers.
  RealArray(nanobind::handle value, const char* name);
  ~RealArray() { PyBuffer_Release(&view_); }
  RealArray(const RealArray&) = delete;
  RealArray& operator=(const RealArray&) = delete;

  int ndim() const { return view_.ndim; }
  Py_ssize_t shape(int axis) const { return view_.shape[axis]; }
  /// Bytes from one item of the axis to the next.
  Py_ssize_t stride(int axis) const { return view_.strides[axis]; }
  const char* data() const { return static_cast<const char*>(view_.buf); }
  /// An item of an array with one axis.
  double operator[](Py_ssize_t i) const { return Load(data() + i * stride(0)); }
  /// An item of an array with two axes.
  double operator()(Py_ssize_t i, Py_ssize_t j) const {
    return Load(data() + i * stride(0) + j * stride(1));
  }
  /// The number at an address within the array, aligned or not.
  static double Load(const char* item) {
    double value;
    std::memcpy(&value, item, sizeof(value));
    return value;
  }
  /// The shape as Python writes it, for messages.
  std::string shape_text() const;

 private:
  Py_buffer view_{};  // keeps its owner alive
};

/// A real number. @throws std::invalid_argument if it is not a number.
double ToReal(nanobind::handle value, const char* name);

/// The same, or nothing for None.
inline std::optional<double> ToOptionalReal(nanobind::handle value,
                                            const char* name) {
  if (value.is_none()) return std::nullopt;
  return ToReal(value, name);
}

/// The index of an object, of which there are `size`. Accepts what lists do, so
/// that NumPy's integers are accepted.
/// @throws nanobind::index_error if there is no such object.
int ToObjectIndex(nanobind::handle value, int size);

/// The class of a value, for messages.
std::string TypeName(nanobind::handle value);

}  // namespace drake_haptics
