#include <stdexcept>
#include <string>
#include <utility>

#include "base/autodiff.h"
#include "bind/bind.h"

namespace nb = nanobind;

namespace drake_haptics {

void BindAutoDiff(nb::module_& m) {
  nb::class_<AutoDiffVector>(
      m, "AutoDiffVector",
      "Numbers with their derivatives by D variables that all arguments of a "
      "call have in common. Immutable.")
      .def(
          "__init__",
          [](AutoDiffVector* self, Eigen::VectorXd value,
             Eigen::MatrixXd gradient) {
            if (gradient.rows() != value.size()) {
              throw std::invalid_argument(
                  "gradient must have a row for each of the " +
                  std::to_string(value.size()) + " values, has " +
                  std::to_string(gradient.rows()));
            }
            new (self) AutoDiffVector{std::move(value), std::move(gradient)};
          },
          nb::arg("value"), nb::arg("gradient"),
          "Args:\n"
          "    value: (n,) values.\n"
          "    gradient: (n, D) derivatives.\n\n"
          "Raises:\n"
          "    ValueError: the sizes do not match.")
      .def("__len__", &AutoDiffVector::size)
      .def_ro("value", &AutoDiffVector::value, "(n,).")
      .def_ro("gradient", &AutoDiffVector::gradient, "(n, D).");
}

}  // namespace drake_haptics
