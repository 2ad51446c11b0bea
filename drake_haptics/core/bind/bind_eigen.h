#pragma once

#include <nanobind/eigen/dense.h>

#include <cstring>
#include <new>

#include "bind/bind_real_array.h"

namespace drake_haptics {

/// NumPy functions that are called, looked up as the module is loaded: an
/// import can fail and can run any code, which a conversion must not.
struct NumpyFunctions {
  PyObject* asarray = nullptr;
  PyObject* empty = nullptr;
};
inline NumpyFunctions numpy_functions;

/// @throws nanobind::python_error if there is no NumPy.
void ImportNumpy();

}  // namespace drake_haptics

/// Vectors and matrices of doubles to and from NumPy. bind.h includes this for
/// all bindings: with nanobind/eigen/dense.h alone two of them would disagree.
///
/// nanobind passes every array by DLPack and NumPy's `asarray` and `copy`,
/// which takes a microsecond in each direction for an array of a wrench's size.
/// Here an array of doubles is read in place, and results are copied into a
/// fresh one. nanobind still reads all other arrays that it can.
namespace nanobind::detail {

// As an integer: Eigen has an enumeration of its own for each type.
template <typename T>
constexpr int kMatrixOptions = Eigen::internal::traits<T>::Options;

template <typename T>
concept AlignedMatrix = std::is_same_v<typename T::Scalar, double> &&
                        std::is_base_of_v<Eigen::MatrixBase<T>, T> &&
                        !(kMatrixOptions<T> & Eigen::DontAlign);

// Like nanobind's own caster of such types, but more constrained.
template <AlignedMatrix T>
struct type_caster<T, enable_if_t<is_eigen_plain_v<T> &&
                                  is_ndarray_scalar_v<typename T::Scalar>>> {
  static constexpr int rows = T::RowsAtCompileTime;
  static constexpr int columns = T::ColsAtCompileTime;
  // The type that nanobind's own caster takes, which differs in alignment
  // alone.
  using Other = Eigen::Matrix<double, rows, columns,
                              kMatrixOptions<T> | Eigen::DontAlign>;
  static constexpr int kDimensions = ndim_v<T>;

  NB_TYPE_CASTER(T, make_caster<Other>::Name)

  bool from_python(handle source, uint32_t flags,
                   cleanup_list* cleanup) noexcept {
    switch (Read(source.ptr())) {
      case Found::kDoubles:
        return true;
      case Found::kTooLarge:
        return false;
      case Found::kNoStrides: {
        const object array = AsArray(source.ptr());
        return array.is_valid() && from_python(array, flags, cleanup);
      }
      default:
        return FromOther(source, flags, cleanup);
    }
  }

  static handle from_cpp(const T& matrix, rv_policy, cleanup_list*) noexcept {
    PyObject* const array = NewArray(matrix.rows(), matrix.cols());
    Py_buffer view;
    if (array == nullptr ||
        PyObject_GetBuffer(array, &view, PyBUF_WRITABLE) != 0) {
      Py_XDECREF(array);
      return {};
    }
    // Rows one after the other, as NumPy has them.
    using ByRows =
        Eigen::Matrix<double, rows, columns,
                      columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
    Eigen::Map<ByRows>(static_cast<double*>(view.buf), matrix.rows(),
                       matrix.cols()) = matrix;
    PyBuffer_Release(&view);
    return array;
  }

 private:
  // Kind of a value that was read.
  enum class Found {
    kDoubles,    // an array of doubles of this shape, read
    kTooLarge,   // such an array that zero strides make larger than memory
    kNoStrides,  // a buffer that leaves its strides out, as those of ctypes do:
                 // nanobind's own caster would follow a null pointer
    kOther
  };

  static object AsArray(PyObject* source) noexcept {
    PyObject* const asarray = drake_haptics::numpy_functions.asarray;
    // The call of one argument that the stable ABI of 3.12 has.
    object array = steal(PyObject_Vectorcall(asarray, &source, 1, nullptr));
    if (!array.is_valid()) PyErr_Clear();
    return array;
  }

  bool FromOther(handle source, uint32_t flags, cleanup_list* cleanup) noexcept
      try {
    make_caster<Other> other;
    if (!other.from_python(source, flags, cleanup)) return false;
    value = other.value;
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }

  static PyObject* NewArray(Py_ssize_t num_rows, Py_ssize_t num_columns) {
    PyObject* const empty = drake_haptics::numpy_functions.empty;
    PyObject* const shape = kDimensions == 1
                                ? PyLong_FromSsize_t(num_rows * num_columns)
                                : Py_BuildValue("(nn)", num_rows, num_columns);
    if (shape == nullptr) return nullptr;
    PyObject* const array = PyObject_Vectorcall(empty, &shape, 1, nullptr);
    Py_DECREF(shape);
    return array;
  }

  Found Read(PyObject* source) noexcept {
    if (!PyObject_CheckBuffer(source)) return Found::kOther;
    Py_buffer view;
    if (PyObject_GetBuffer(source, &view, PyBUF_RECORDS_RO) != 0) {
      PyErr_Clear();
      return Found::kOther;
    }
    Found found = Found::kOther;
    if (view.ndim > 0 && view.strides == nullptr) {
      found = Found::kNoStrides;
    } else if (Fits(view)) {
      found = TryCopy(view) ? Found::kDoubles : Found::kTooLarge;
    }
    PyBuffer_Release(&view);
    return found;
  }

  bool TryCopy(const Py_buffer& view) noexcept try {
    Copy(view);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }

  static bool Fits(const Py_buffer& view) {
    if (view.format == nullptr || std::strcmp(view.format, "d") != 0 ||
        view.ndim != kDimensions) {
      return false;
    }
    if constexpr (kDimensions == 1) {
      constexpr int size = T::SizeAtCompileTime;
      return size == Eigen::Dynamic || view.shape[0] == size;
    } else {
      return (rows == Eigen::Dynamic || view.shape[0] == rows) &&
             (columns == Eigen::Dynamic || view.shape[1] == columns);
    }
  }

  void Copy(const Py_buffer& view) {
    using drake_haptics::RealArray;
    const Py_ssize_t inner = view.strides[kDimensions - 1];
    const char* const items = static_cast<const char*>(view.buf);
    if constexpr (kDimensions == 1) {
      value.resize(view.shape[0]);
      for (Py_ssize_t i = 0; i < view.shape[0]; ++i) {
        value[i] = RealArray::Load(items + i * inner);
      }
    } else {
      value.resize(view.shape[0], view.shape[1]);
      for (Py_ssize_t i = 0; i < view.shape[0]; ++i) {
        const char* const row = items + i * view.strides[0];
        for (Py_ssize_t j = 0; j < view.shape[1]; ++j) {
          value(i, j) = RealArray::Load(row + j * inner);
        }
      }
    }
  }
};

}  // namespace nanobind::detail
