#include "base/autodiff.h"
#include "bind/bind.h"
#include "tool/passivity.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

template <typename T>
Eigen::Matrix<T, 14, 1> Control(const Eigen::Matrix<T, 8, 1>& state,
                                const Eigen::Matrix<T, 6, 1>& F_Ho_W_rendered,
                                const Eigen::Matrix<T, 6, 1>& F_Ho_W_desired,
                                const Eigen::Matrix<T, 7, 1>& q_WH,
                                const Eigen::Matrix<T, 6, 1>& V_WH,
                                const PassivityBounds& bounds) {
  const T work =
      HeldWrenchWork<T>(F_Ho_W_rendered, state.template tail<7>(), q_WH);
  const T balance = ObserveEnergy<T>(state[0], work, bounds);
  Eigen::Matrix<T, 14, 1> out;
  out << LimitEnergy(F_Ho_W_desired, balance, V_WH, bounds), balance, q_WH;
  return out;
}

AutoDiffVector DifferentiateControl(const AutoDiffVector& state,
                                    const AutoDiffVector& F_Ho_W_rendered,
                                    const AutoDiffVector& F_Ho_W_desired,
                                    const AutoDiffVector& q_WH,
                                    const AutoDiffVector& V_WH,
                                    const PassivityBounds& bounds) {
  const Eigen::Index num_derivatives =
      CommonNumDerivatives(state, F_Ho_W_rendered, F_Ho_W_desired, q_WH, V_WH);
  return ToAutoDiffVector(
      Control(ToScalars<8>(state, "state"),
              ToScalars<6>(F_Ho_W_rendered, "F_Ho_W_rendered"),
              ToScalars<6>(F_Ho_W_desired, "F_Ho_W_desired"),
              ToScalars<7>(q_WH, "q_WH"), ToScalars<6>(V_WH, "V_WH"), bounds),
      num_derivatives);
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
          "    period_s: duration of a tick, s.\n"
          "    max_damping_Ns_per_m: largest damping, N·s/m.\n"
          "    max_rotational_damping_Nms_per_rad: largest rotational damping, "
          "N·m·s/rad.\n"
          "    reserve_J: largest balance that is kept, J.\n\n"
          "Raises:\n"
          "    ValueError: the period is not above 0, another bound is below "
          "0, or one of them is not finite.");
  m.def(
      "passivity_control", &Control<double>, nb::arg("state"),
      nb::arg("F_Ho_W_rendered"), nb::arg("F_Ho_W_desired"), nb::arg("q_WH"),
      nb::arg("V_WH"), nb::arg("bounds"),
      "Passivity observer and controller (Hannaford and Ryu 2002) of one "
      "tick.\n\n"
      "Args:\n"
      "    state: (8,) balance of the last tick, J, and the handle's pose "
      "then.\n"
      "    F_Ho_W_rendered: (6,) wrench on the handle at Ho in W that was held "
      "since then, [N·m; N].\n"
      "    F_Ho_W_desired: (6,) wrench that is desired now.\n"
      "    q_WH: (7,) pose now, [qw qx qy qz x y z].\n"
      "    V_WH: (6,) spatial velocity now, [rad/s; m/s].\n\n"
      "Returns:\n"
      "    (14,) wrench to show (6), F_Ho_W_desired itself where the balance "
      "is not below 0; then the next state (8), the balance and pose now.");
  m.def("passivity_control", &DifferentiateControl, nb::arg("state"),
        nb::arg("F_Ho_W_rendered"), nb::arg("F_Ho_W_desired"), nb::arg("q_WH"),
        nb::arg("V_WH"), nb::arg("bounds"), "The same with derivatives.");
}

}  // namespace drake_haptics
