#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/autodiff.h"
#include "base/frame_change.h"
#include "bind/bind.h"
#include "bind/bind_array.h"
#include "tool/arm_dynamics.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

template <typename T>
using State = Eigen::Matrix<T, 12, 1>;
using CubicsArg = nb::ndarray<const double, nb::shape<-1, 4, 7>, nb::c_contig,
                              nb::device::cpu>;

PosePath MakePath(std::vector<double> starts, const CubicsArg& cubics,
                  double period) {
  if (starts.empty() || starts.size() != cubics.shape(0) || !(period > 0)) {
    throw std::invalid_argument(
        "a path needs a cubic for each start, one at least, and a period above "
        "0 s");
  }
  PosePath path{std::move(starts), {}, period};
  for (std::size_t i = 0; i < cubics.shape(0); ++i) {
    path.cubics.emplace_back(
        Eigen::Map<const PosePath::Cubic>(cubics.data() + 28 * i));
  }
  return path;
}

void RequireFinite(const Eigen::Ref<const Eigen::VectorXd>& values,
                   const char* refusal) {
  if (!values.allFinite()) {
    PyErr_SetString(PyExc_FloatingPointError, refusal);
    throw nb::python_error();
  }
}

template <typename T>
void RequireFinite(const State<T>& state) {
  RequireFinite(ValuesOf(state), "the arm's state is not finite");
}

template <typename T>
Eigen::Matrix<T, 13, 1> CalcHandleState(const ArmDynamics& held,
                                        const State<T>& state) {
  RequireFinite(state);
  const MovingPoseOf<T> pose = held.arm.Evaluate(state).pose;
  Eigen::Matrix<T, 13, 1> out;
  out << pose.q, pose.V;
  return out;
}

template <typename T>
Vec6Of<T> JointTorques(const ArmDynamics& held, const T& time,
                       const State<T>& state,
                       const Vec6Of<T>& F_Ho_W_rendered) {
  RequireFinite(state);
  return held.JointTorques<T>(time, state, F_Ho_W_rendered);
}

void BindPath(nb::module_& m) {
  nb::class_<PosePath>(m, "PosePath",
                       "A pose over time, a cubic per segment. Immutable.")
      .def(
          "__init__",
          [](PosePath* self, std::vector<double> starts_s,
             const CubicsArg& cubics, double period_s) {
            new (self)
                PosePath(MakePath(std::move(starts_s), cubics, period_s));
          },
          nb::arg("starts_s"), nb::arg("cubics"), nb::arg("period_s"),
          "Path of m segments.\n\n"
          "Args:\n"
          "    starts_s: (m,) starts of the segments, rising from 0 s. The "
          "last one never ends.\n"
          "    cubics: (m, 4, 7) coefficients by power of the time since the "
          "start, of [qw qx qy qz x y z]; the quaternion may have any length.\n"
          "    period_s: time until the path repeats, s; infinite if never.\n\n"
          "Raises:\n"
          "    ValueError: sizes do not match or there is no period.")
      .def(
          "evaluate",
          [](const PosePath& self, double time) {
            const MovingPose pose = self.Evaluate(time);
            return std::pair(pose.q, pose.V);
          },
          nb::arg("time_s"),
          "Returns the pose (7,) and the spatial velocity (6,) at its origin, "
          "[rad/s; m/s].");
}

void BindHeldArm(nb::module_& m) {
  nb::class_<ArmDynamics>(
      m, "ArmDynamics",
      "A chain of six revolute joints and a hand that pulls its handle H along "
      "a path. States are (12,): angles, rad, and speeds, rad/s. All methods "
      "raise FloatingPointError where a state is not finite.")
      .def(
          "__init__",
          [](ArmDynamics* self, const Mat6& J_WH, const PoseVector& q_WH,
             const PosePath& path, const PoseVector& q_PH,
             const CouplingGains& gains) {
            new (self) ArmDynamics{SixJointArm(J_WH, q_WH), path, q_PH, gains};
          },
          nb::arg("J_WH"), nb::arg("q_WH"), nb::arg("path"), nb::arg("q_PH"),
          nb::arg("gains"),
          "Args:\n"
          "    J_WH: (6, 6) spatial velocity of H per joint speed, all angles "
          "zero.\n"
          "    q_WH: (7,) pose of H, all angles zero.\n"
          "    path: pose X_WP over time.\n"
          "    q_PH: (7,) pose in P at which the hand wants the handle.\n"
          "    gains: gains of the hand's spring and damper.")
      .def("calc_handle_state", &CalcHandleState<double>, nb::arg("state"),
           "Pose X_WH and spatial velocity V_WH, (13,) = [pose (7); rad/s; "
           "m/s].")
      .def(
          "calc_handle_state",
          [](const ArmDynamics& self, const AutoDiffVector& state) {
            return ToAutoDiffVector(
                CalcHandleState<AutoDiff>(self, ToScalars<12>(state, "state")),
                state.num_derivatives());
          },
          nb::arg("state"), "The same with derivatives.")
      .def("calc_joint_torques", &JointTorques<double>, nb::arg("time_s"),
           nb::arg("state"), nb::arg("F_Ho_W_rendered"),
           "Joint torques (6,), N·m, of the hand and of a wrench (6,) on the "
           "handle at its origin in the world, [N·m; N].")
      .def(
          "calc_joint_torques",
          [](const ArmDynamics& self, const AutoDiffVector& time,
             const AutoDiffVector& state,
             const AutoDiffVector& F_Ho_W_rendered) {
            const Eigen::Index num_derivatives =
                CommonNumDerivatives(time, state, F_Ho_W_rendered);
            return ToAutoDiffVector(
                JointTorques<AutoDiff>(
                    self, ToScalars<1>(time, "time_s")[0],
                    ToScalars<12>(state, "state"),
                    ToScalars<6>(F_Ho_W_rendered, "F_Ho_W_rendered")),
                num_derivatives);
          },
          nb::arg("time_s"), nb::arg("state"), nb::arg("F_Ho_W_rendered"),
          "The same with derivatives; `time_s` is (1,).");
}

// Error of a quaternion's length, from the few digits that a device may send.
constexpr double kQuaternionTolerance = 1e-3;

void BindFrameChange(nb::module_& m) {
  using Slope = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  nb::class_<FrameChange>(m, "FrameChange",
                          "Changes poses and velocities from a frame B to a "
                          "frame A in which B rests, and wrenches from A to B.")
      .def(nb::init<const PoseVector&>(), nb::arg("X_AB"),
           "Pose (7,) of B in A, [qw qx qy qz x y z], m.\n\n"
           "Raises:\n    ValueError: it is not a pose.")
      .def("change_motion", &FrameChange::ChangeMotion, nb::arg("X_BH"),
           nb::arg("V_BH"),
           "Pose and spatial velocity of H in A, (13,), from those in B: (7,), "
           "m, and (6,), [rad/s; m/s].")
      .def(
          "change_reading",
          [](const FrameChange& self, const PoseVector& X_BH, const Vec6& V_BH,
             const Vec6& F_Ho_B, double sequence, double time, double buttons,
             double gate, double fault) {
            Eigen::Matrix<double, 37, 1> state;
            state << self.ChangeMotion(X_BH, V_BH), X_BH, V_BH, F_Ho_B,
                sequence, time, buttons, gate, fault;
            RequireFinite(state.head<13>(),
                          "the device's reading is not finite");
            if (std::abs(X_BH.head<4>().norm() - 1.0) > kQuaternionTolerance) {
              throw std::invalid_argument(
                  "the quaternion in X_BH must have length 1");
            }
            return state;
          },
          nb::arg("X_BH"), nb::arg("V_BH"), nb::arg("F_Ho_B"),
          nb::arg("sequence"), nb::arg("time_s"), nb::arg("buttons"),
          nb::arg("gate"), nb::arg("fault"),
          "The motion of H in A (13,), followed by all numbers of a "
          "`DeviceReading` (24,).\n\n"
          "Raises:\n"
          "    FloatingPointError: the motion is not finite.\n"
          "    ValueError: the quaternion is not of length 1, to 1e-3.")
      .def(
          "change_wrench_back",
          [](const FrameChange& self, const Vec6& F_A) {
            return self.ChangeBack(F_A);
          },
          nb::arg("F_A"), "Wrench (6,) in B from that in A, [N·m; N].")
      .def(
          "change_slopes_back",
          [](const FrameChange& self,
             const Eigen::Matrix<double, 72, 1>& slopes_A) {
            const double* const K = slopes_A.data();
            return std::pair<Slope, Slope>(
                self.ChangeBack(Mat6(Eigen::Map<const Slope>(K))),
                self.ChangeBack(Mat6(Eigen::Map<const Slope>(K + 36))));
          },
          nb::arg("slopes_A"),
          "Stiffness and damping (6, 6) in B from those in A, (72,) by rows.");
}

}  // namespace

void BindHand(nb::module_& m) {
  BindFrameChange(m);
  BindPath(m);
  BindHeldArm(m);
}

}  // namespace drake_haptics
