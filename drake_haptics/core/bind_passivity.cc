#include <nanobind/eigen/dense.h>

#include "bind.h"
#include "passivity.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using State = Eigen::Matrix<double, 8, 1>;
using Shown = Eigen::Matrix<double, 14, 1>;

Shown Control(const State& state, const Vec6& F_applied, const Vec6& F_asked,
              const PoseVector& q_WH, const Vec6& V_WH,
              const PassivityBounds& bounds) {
  const double work = HeldWrenchWork(F_applied, state.tail<7>(), q_WH);
  const double balance = ObserveEnergy(state[0], work, bounds);
  Shown out;
  out << LimitEnergy(F_asked, balance, V_WH, bounds), balance, q_WH;
  return out;
}

}  // namespace

void BindPassivity(nb::module_& m) {
  nb::class_<PassivityBounds>(m, "PassivityBounds",
                              "Bounds of the passivity controller.")
      .def(
          "__init__",
          [](PassivityBounds* self, double period, double damping,
             double rotational_damping, double reserve) {
            const PassivityBounds bounds{period, damping, rotational_damping,
                                         reserve};
            RequirePossible(bounds);
            new (self) PassivityBounds(bounds);
          },
          nb::arg("period_s"), nb::arg("max_damping_Ns_per_m"),
          nb::arg("max_rotational_damping_Nms_per_rad"), nb::arg("reserve_J"),
          "Args:\n"
          "    period_s: the tick, s.\n"
          "    max_damping_Ns_per_m: largest damping, N·s/m.\n"
          "    max_rotational_damping_Nms_per_rad: N·m·s/rad.\n"
          "    reserve_J: largest balance that is kept, J.\n\n"
          "Raises:\n"
          "    ValueError: the period is not above 0, another one below 0, or "
          "one of them not finite.");
  m.def("passivity_control", &Control, nb::arg("state"), nb::arg("F_applied"),
        nb::arg("F_asked"), nb::arg("q_WH"), nb::arg("V_WH"), nb::arg("bounds"),
        "Passivity observer and controller (Hannaford and Ryu 2002) of one "
        "tick.\n\n"
        "Args:\n"
        "    state: (8,) balance of the last tick, J, and the handle's pose "
        "then.\n"
        "    F_applied: (6,) wrench on the handle at Ho in W that was held "
        "since, [N·m; N].\n"
        "    F_asked: (6,) wrench asked for now.\n"
        "    q_WH: (7,) pose now, [qw qx qy qz x y z].\n"
        "    V_WH: (6,) spatial velocity now, [rad/s; m/s].\n\n"
        "Returns:\n"
        "    (14,) wrench to show (6), F_asked itself where the balance is not "
        "below 0; the next state (8), balance now, J, and pose now.");
}

}  // namespace drake_haptics
