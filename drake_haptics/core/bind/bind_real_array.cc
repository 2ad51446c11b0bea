#include "bind/bind_real_array.h"

#include <nanobind/stl/string.h>

#include <stdexcept>

namespace nb = nanobind;

namespace drake_haptics {
namespace {

bool IsNativeDouble(const Py_buffer& view) {
  return view.format != nullptr && std::strcmp(view.format, "d") == 0;
}

// Points `view` at the memory of an array of doubles; returns false for
// anything else.
bool ViewDoubles(nb::handle value, Py_buffer* view) {
  if (!PyObject_CheckBuffer(value.ptr())) return false;
  if (PyObject_GetBuffer(value.ptr(), view, PyBUF_RECORDS_RO) != 0) {
    PyErr_Clear();
    return false;
  }
  if (IsNativeDouble(*view)) return true;
  PyBuffer_Release(view);
  return false;
}

// Converts real numbers of any other kind by NumPy: int, float32, lists.
nb::object ToDoubles(nb::handle value, const char* name) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  try {
    const nb::object array = numpy.attr("asarray")(value);
    const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
    if (kind == "i" || kind == "u" || kind == "f") {
      return numpy.attr("asarray")(array, "float64");
    }
  } catch (nb::python_error& error) {
    // Ragged lists, for instance; an interrupt is passed on.
    if (!error.matches(PyExc_Exception)) throw;
  }
  throw std::invalid_argument(std::string(name) +
                              " must be an array of real numbers, got " +
                              TypeName(value));
}

}  // namespace

RealArray::RealArray(nb::handle value, const char* name) {
  if (ViewDoubles(value, &view_)) return;
  if (!ViewDoubles(ToDoubles(value, name), &view_)) {
    throw std::invalid_argument(std::string(name) +
                                " must be an array of real numbers");
  }
}

std::string RealArray::shape_text() const {
  std::string text = "(";
  for (int axis = 0; axis < ndim(); ++axis) {
    text += (axis > 0 ? ", " : "") + std::to_string(shape(axis));
  }
  return text + (ndim() == 1 ? ",)" : ")");
}

double ToReal(nb::handle value, const char* name) {
  const double real = PyFloat_AsDouble(value.ptr());
  if (real == -1.0 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw std::invalid_argument(
        std::string(name) + " must be a real number, got " + TypeName(value));
  }
  return real;
}

int ToObjectIndex(nb::handle value, int size) {
  const Py_ssize_t i = PyNumber_AsSsize_t(value.ptr(), PyExc_IndexError);
  if (i == -1 && PyErr_Occurred() != nullptr) throw nb::python_error();
  if (i < 0 || i >= size) {
    const auto text =
        "no object " + std::to_string(i) + " of " + std::to_string(size);
    throw nb::index_error(text.c_str());
  }
  return static_cast<int>(i);
}

std::string TypeName(nb::handle value) {
  // For an array, the type of its numbers says more than its class.
  if (nb::hasattr(value, "dtype")) {
    return std::string(nb::str(nb::object(value.attr("dtype"))).c_str()) +
           " values";
  }
  return nb::cast<std::string>(value.type().attr("__name__"));
}

}  // namespace drake_haptics
