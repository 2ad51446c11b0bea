#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/autodiff.h"
#include "base/require.h"
#include "base/wrench_limit.h"
#include "bind/bind.h"
#include "bind/bind_columns.h"
#include "bind/bind_joined_coupling.h"
#include "law/tool_gravity.h"
#include "tool/rigid_tool.h"
#include "tool/virtual_coupling.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

template <typename T>
Eigen::Matrix<T, kWrenchModelSize + 6, 1> ToVector(
    const CouplingWrenchOf<T>& wrench) {
  Eigen::Matrix<T, kWrenchModelSize + 6, 1> out;
  out << drake_haptics::ToVector(wrench.tool), wrench.F_Ho_W_commanded;
  return out;
}

template <typename T>
ToolStateVectorOf<T> Step(const ToolInertia& inertia,
                          const Eigen::Matrix<T, 13, 1>& state,
                          const Eigen::Matrix<T, kWrenchModelSize, 1>& wrench,
                          double h) {
  return drake_haptics::ToVector(
      StepTool(inertia, ToToolState(state), ToWrenchModel(wrench), h));
}

void RequireLimit(double limit, const char* name) {
  if (limit != std::numeric_limits<double>::infinity()) {
    RequirePositive(limit, name);
  }
}

CouplingGains MakeGains(double k, double b, double kr, double br,
                        double max_force, double max_torque) {
  for (const double gain : {k, b, kr, br}) {
    if (!std::isfinite(gain) || gain < 0) {
      throw std::invalid_argument(
          "coupling gains must be finite and at least 0");
    }
  }
  RequireLimit(max_force, "max_force_N");
  RequireLimit(max_torque, "max_torque_Nm");
  return {k, b, kr, br, max_force, max_torque};
}

// Takes what has no derivatives from `values`, and all else from `in`.
template <typename T>
auto CoupleJoined(const JoinedVector<T>& in,
                  const JoinedVector<double>& values) {
  const PoseVector q_HT = values.tail<7>();
  return ComputeCoupling<T>(in.template head<7>(), in.template segment<6>(7),
                            q_HT, in.template segment<7>(13),
                            in.template segment<6>(20),
                            MakeGains(values[26], values[27], values[28],
                                      values[29], values[30], values[31]));
}

void BindJoinedCoupling(nb::module_& m) {
  m.def(
      "joined_coupling_wrench",
      [](const JoinedVector<double>& joined) {
        return ToVector(ComputeJoinedCoupling(joined));
      },
      nb::arg("joined"),
      "Wrenches of the virtual coupling between handle H and tool, from one "
      "vector as a multiplexer joins it: each array that is passed takes as "
      "long as the law.\n\n"
      "Args:\n"
      "    joined: (39,) [q_WH; V_WH; q_WT; V_WT; gains; q_HT], the gains (6) "
      "in the order of `CouplingGains`, q_HT the pose of the tool in the "
      "handle at rest; poses [qw qx qy qz x y z], spatial velocities [rad/s; "
      "m/s].\n\n"
      "Returns:\n"
      "    (84,): wrench model on the tool at To (78), then the reaction on "
      "the handle at Ho in W (6).\n\n"
      "Raises:\n"
      "    ValueError: a gain is out of range.");
  m.def(
      "joined_coupling_wrench",
      [](const AutoDiffVector& joined) {
        const auto in = ToScalars<39>(joined, "joined");
        if (!joined.gradient.bottomRows<13>().isZero(0.0)) {
          throw std::invalid_argument(
              "joined must have no derivatives of the gains and of q_HT: the "
              "coupling is not differentiated by them");
        }
        return ToAutoDiffVector(
            ToVector(CoupleJoined<AutoDiff>(in, joined.value)),
            joined.num_derivatives());
      },
      nb::arg("joined"),
      "The same with derivatives by all but the gains and q_HT.");
}

nb::tuple ToTuple(const CouplingGains& gains) {
  return nb::make_tuple(gains.stiffness, gains.damping,
                        gains.rotational_stiffness, gains.rotational_damping,
                        gains.max_force, gains.max_torque);
}

void BindCoupling(nb::module_& m) {
  nb::class_<CouplingGains> gains(
      m, "CouplingGains",
      "Gains of the virtual coupling's spring and damper, and the largest "
      "norms of the force and torque of both together. Immutable; equal if all "
      "numbers are.");
  DefFrozenCopy(&gains);
  gains
      .def(
          "__init__",
          [](CouplingGains* self, double k, double b, double kr, double br,
             double max_force, double max_torque) {
            new (self)
                CouplingGains(MakeGains(k, b, kr, br, max_force, max_torque));
          },
          nb::arg("stiffness_N_per_m"), nb::arg("damping_Ns_per_m"),
          nb::arg("rotational_stiffness_Nm_per_rad"),
          nb::arg("rotational_damping_Nms_per_rad"),
          nb::arg("max_force_N") = std::numeric_limits<double>::infinity(),
          nb::arg("max_torque_Nm") = std::numeric_limits<double>::infinity())
      .def_ro("stiffness_N_per_m", &CouplingGains::stiffness)
      .def_ro("damping_Ns_per_m", &CouplingGains::damping)
      .def_ro("rotational_stiffness_Nm_per_rad",
              &CouplingGains::rotational_stiffness)
      .def_ro("rotational_damping_Nms_per_rad",
              &CouplingGains::rotational_damping)
      .def_ro("max_force_N", &CouplingGains::max_force)
      .def_ro("max_torque_Nm", &CouplingGains::max_torque)
      .def(
          "__eq__",
          [](const CouplingGains& self, const CouplingGains& other) {
            return ToTuple(self).equal(ToTuple(other));
          },
          nb::is_operator(),
          nb::sig("def __eq__(self, arg: object, /) -> bool"))
      .def("__hash__",
           [](const CouplingGains& self) { return nb::hash(ToTuple(self)); })
      .def("__repr__", [](const CouplingGains& self) {
        std::ostringstream text;
        text << "CouplingGains(" << self.stiffness << " N/m, " << self.damping
             << " N·s/m, " << self.rotational_stiffness << " N·m/rad, "
             << self.rotational_damping << " N·m·s/rad";
        if (std::isfinite(self.max_force)) {
          text << ", at most " << self.max_force << " N";
        }
        if (std::isfinite(self.max_torque)) {
          text << ", at most " << self.max_torque << " N·m";
        }
        text << ")";
        return text.str();
      });
}

void BindRigidTool(nb::module_& m) {
  nb::class_<ToolInertia>(m, "RigidToolDynamics",
                          "A free rigid tool, advanced implicitly.")
      .def(
          "__init__",
          [](ToolInertia* self, double mass, const Vec3& p_TTcm,
             const Mat3& I_TTcm_T) {
            const ToolInertia inertia{mass, p_TTcm, I_TTcm_T};
            RequirePhysical(inertia);
            new (self) ToolInertia(inertia);
          },
          nb::arg("mass_kg"), nb::arg("p_TTcm"), nb::arg("I_TTcm_T"),
          "Tool of `mass_kg`, center of mass (3,) m and rotational inertia "
          "about it (3, 3) kg·m², both in the tool's frame.\n\n"
          "Raises:\n    ValueError: a value is not finite, the mass not above "
          "0, or the inertia not symmetric and positive definite.")
      .def_ro("mass_kg", &ToolInertia::mass, "Mass, kg.")
      .def_ro("p_TTcm", &ToolInertia::p_TTcm,
              "Center of mass (3,) in the tool's frame, m.")
      // The overload that each tick calls is first: trying another takes as
      // long as the step.
      .def(
          "step",
          [](const ToolInertia& self, const Eigen::Matrix<double, 13, 1>& state,
             const std::vector<WrenchModelVector>& wrenches, double h) {
            WrenchModelVector sum = WrenchModelVector::Zero();
            for (const WrenchModelVector& wrench : wrenches) sum += wrench;
            return Step(self, state, sum, h);
          },
          nb::arg("state"), nb::arg("wrench_models"), nb::arg("h"),
          "Advances the state (13,) = [pose (7); spatial velocity (6)] by one "
          "linearized backward Euler step of h seconds under the sum of wrench "
          "models (78,).")
      .def(
          "step",
          [](const ToolInertia& self, const Eigen::Matrix<double, 13, 1>& state,
             const WrenchModelVector& wrench,
             double h) { return Step(self, state, wrench, h); },
          nb::arg("state"), nb::arg("wrench_model"), nb::arg("h"),
          "The same under one wrench model (78,).")
      .def(
          "step",
          [](const ToolInertia& self, const AutoDiffVector& state,
             const AutoDiffVector& wrench, double h) {
            const Eigen::Index num_derivatives =
                CommonNumDerivatives(state, wrench);
            return ToAutoDiffVector(
                Step(self, ToScalars<13>(state, "state"),
                     ToScalars<kWrenchModelSize>(wrench, "wrench_model"), h),
                num_derivatives);
          },
          nb::arg("state"), nb::arg("wrench_model"), nb::arg("h"),
          "The same with derivatives.");
}

Eigen::Matrix<double, 7, 1> Limit(const Vec6& F, double max_torque,
                                  double max_force) {
  RequireNotNegative(max_torque, "max_torque_Nm");
  RequireNotNegative(max_force, "max_force_N");
  const LimitedWrench limited = LimitWrench(F, max_torque, max_force);
  Eigen::Matrix<double, 7, 1> out;
  out << limited.F, static_cast<double>(limited.fate);
  return out;
}

void BindLimit(nb::module_& m) {
  m.def("limit_wrench", &Limit, nb::arg("F"), nb::arg("max_torque_Nm"),
        nb::arg("max_force_N"),
        "Shortens torque and force of a wrench (6,), [N·m; N], each to its "
        "limit, along its own direction.\n\n"
        "Returns:\n"
        "    (7,): the limited wrench and a number: 0 if it is unchanged, 1 if "
        "it was limited, 2 if it was not finite and is zero.\n\n"
        "Raises:\n"
        "    ValueError: a limit is negative or not finite.");
  m.def(
      "limit_coupling",
      [](const JoinedVector<double>& joined, double max_torque,
         double max_force) {
        return Limit(ComputeJoinedCoupling(joined).F_Ho_W_commanded, max_torque,
                     max_force);
      },
      nb::arg("joined"), nb::arg("max_torque_Nm"), nb::arg("max_force_N"),
      "The same for the reaction on the handle of `joined_coupling_wrench`.\n\n"
      "Raises:\n"
      "    ValueError: a limit is negative or not finite, or a gain is out of "
      "range.");
}

void BindWeight(nb::module_& m) {
  m.def("tool_weight", &ToolWeight<double>, nb::arg("q_WT"), nb::arg("p_TTcm"),
        nb::arg("weight_W"),
        "Weight of the tool, a force at its center of mass.\n\n"
        "Args:\n"
        "    q_WT: (7,) pose [qw qx qy qz x y z].\n"
        "    p_TTcm: (3,) center of mass in the tool's frame, m.\n"
        "    weight_W: (3,) mass times gravity, N.\n\n"
        "Returns:\n"
        "    (6,) wrench on the tool at To in W, [N·m; N].");
  m.def(
      "tool_weight",
      [](const AutoDiffVector& q_WT, const Vec3& p_TTcm, const Vec3& weight_W) {
        return ToAutoDiffVector(
            ToolWeight(ToScalars<7>(q_WT, "q_WT"), p_TTcm, weight_W),
            q_WT.num_derivatives());
      },
      nb::arg("q_WT"), nb::arg("p_TTcm"), nb::arg("weight_W"),
      "The same with derivatives.");
}

}  // namespace

CouplingWrench ComputeJoinedCoupling(const JoinedVector<double>& joined) {
  return CoupleJoined<double>(joined, joined);
}

void BindTool(nb::module_& m) {
  BindCoupling(m);
  BindJoinedCoupling(m);
  BindLimit(m);
  BindRigidTool(m);
  BindWeight(m);
}

}  // namespace drake_haptics
