#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bind/bind.h"
#include "bind/bind_array.h"
#include "bind/bind_columns.h"
#include "bind/bind_pose.h"
#include "bind/bind_real_array.h"
#include "bind/bind_servo.h"
#include "bind/bind_shapes.h"
#include "bind/bind_turn.h"
#include "constraint/constraint_step.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Result = ConstraintStepResult;

// A stepper whose users take turns.
class SharedStepper {
 public:
  SharedStepper(nb::handle tool, nb::handle objects, nb::handle skin,
                const ToolInertia& dynamics, const CouplingGains& gains,
                const PoseVector& q_HT, double period)
      : stepper_(ToDecomposition(tool, "tool"), ToDecompositions(objects),
                 {dynamics, gains, CheckedPose(q_HT, "q_HT"), period,
                  ToNumbers(skin)}) {}
  SharedStepper(const SharedStepper& other) : stepper_(other.Copy()) {}

  // For what never changes.
  const ConstraintStepper& constants() const { return stepper_; }

  ConstraintStepper Copy() const {
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    return stepper_;
  }

  void SetObjectPose(nb::handle place, nb::handle X_WO_value,
                     const Vec6& V_WO) {
    const Pose X_WO = ToPose(X_WO_value, "X_WO");
    const Py_ssize_t i = PyNumber_AsSsize_t(place.ptr(), PyExc_IndexError);
    if (i == -1 && PyErr_Occurred() != nullptr) throw nb::python_error();
    const Py_ssize_t size = stepper_.num_objects();
    if (i < 0 || i >= size) {
      const auto text =
          "no object " + std::to_string(i) + " of " + std::to_string(size);
      throw nb::index_error(text.c_str());
    }
    const Turn turn(&mutex_, Turn::Gil::kHold);
    stepper_.SetObjectPose(static_cast<int>(i), X_WO, V_WO);
  }

  Result Step(const PoseVector& q_WT, const Vec6& V_WT, const PoseVector& q_WH,
              const Vec6& V_WH, const Vec6& F_applied) {
    Result result;
    const Turn turn(&mutex_, Turn::Gil::kHold);
    const auto start = std::chrono::steady_clock::now();
    stepper_.Step({q_WT, V_WT}, q_WH, V_WH, F_applied, &result);
    const std::chrono::duration<double> elapsed =
        std::chrono::steady_clock::now() - start;
    // The search and the step are one: all of it counts as the query.
    result.contacts.query_seconds = elapsed.count();
    return result;
  }

  void Reset() {
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    stepper_.Reset();
  }

 private:
  static std::vector<double> ToNumbers(nb::handle value) {
    const RealArray array(value, "skin_m");
    if (array.ndim() != 1) {
      throw std::invalid_argument("skin_m must be (num_objects,), has shape " +
                                  array.shape_text());
    }
    std::vector<double> numbers;
    for (Py_ssize_t i = 0; i < array.shape(0); ++i) {
      numbers.push_back(RealArray::Load(array.data() + i * array.stride(0)));
    }
    return numbers;
  }

  static PoseVector CheckedPose(const PoseVector& q, const char* name) {
    PoseFromVector(q, name);
    return q;
  }

  mutable std::mutex mutex_;
  ConstraintStepper stepper_;
};

void BindResult(nb::module_& m) {
  nb::class_<Result> result(
      m, "ConstraintStepResult",
      "What one tick of a `ConstraintStepper` found and did. Immutable.");
  DefFrozenCopy(&result);
  result
      .def_prop_ro(
          "q_WT", [](const Result& r) { return r.next.q_WT; },
          "(7,) pose [qw qx qy qz x y z] of the tool at the tick's end.")
      .def_prop_ro(
          "V_WT", [](const Result& r) { return r.next.V_WT; },
          "(6,) spatial velocity [rad/s; m/s] of the tool at the tick's end.")
      .def_prop_ro(
          "F_Ho_W_commanded",
          [](const Result& r) { return r.F_Ho_W_commanded; },
          "(6,) [torque; force] of the coupling on the handle at Ho in W, at "
          "the tick's beginning: that of `joined_coupling_wrench`.")
      .def_prop_ro(
          "contacts",
          [](nb::handle self) {
            return nb::cast(&nb::cast<const Result&>(self).contacts,
                            nb::rv_policy::reference_internal, self);
          },
          nb::sig("def contacts(self) -> ContactSet"),
          "`ContactSet` of the rows that push, ordered by object and pieces. A "
          "pair has several where it is flush.")
      .def_prop_ro(
          "F_Oo_W",
          [](const Result& r) {
            return ToRows<double, 6>(r.F_Oo_W,
                                     [](const Vec6& F, int k) { return F[k]; });
          },
          "(num_objects, 6) [torque; force] of contact on each object at the "
          "origin of its frame, in W.")
      .def_prop_ro(
          "hessian", [](const Result& r) { return r.hessian; },
          "(6, 6) slope of the forces of the step by the tool's motion in it, "
          "[N·m; N] by [rad; m]: A = M/h² + B/h + K + Σ k a aᵀ over rows "
          "that push. What adds dF to the wrench on the tool adds A⁻¹ dF to "
          "its motion, and A⁻¹ dF / h to V_WT.")
      .def_ro("num_rows", &Result::num_rows,
              "Rows within reach, those that do not push among them.")
      .def_ro("num_substeps", &Result::num_substeps,
              "Parts into which a fast motion was divided, at least 1.")
      .def_ro("num_iterations", &Result::num_iterations,
              "Iterations of Newton's method, all solutions of the tick "
              "together.")
      .def_ro("is_bounded", &Result::is_bounded,
              "Whether a bound on iterations or parts ended the tick: the tool "
              "has then gone less far than it should.")
      .def_ro("least_distance_m", &Result::least_distance,
              "Smallest distance of the tool to an object at the tick's "
              "beginning, m; infinite where none is within reach.")
      .def_ro("is_apart", &Result::is_apart,
              "Whether no pieces touch or overlap at the tick's beginning. "
              "Else the tool is led out at a bounded speed.")
      .def("__repr__", [](const Result& r) {
        return nb::str("ConstraintStepResult({}, {})")
            .format(Counted(static_cast<std::size_t>(r.num_rows), "row"),
                    Counted(r.contacts.contacts.size(), "contact"));
      });
  DefNumbers<&Result::force>(&result, "lambda_N",
                             "(n,) force along the normal of each contact, N.");
}

}  // namespace

ConstraintStepper CopyStepper(nb::handle stepper) {
  return nb::cast<const SharedStepper&>(stepper).Copy();
}

void BindConstraintStep(nb::module_& m) {
  BindResult(m);
  nb::class_<SharedStepper> stepper(
      m, "ConstraintStepper",
      "Contact as a constraint: a rigid tool on a virtual coupling that stays "
      "a skin away from all objects, tick after tick.\n\n"
      "The motion ξ = [θ; t] of To in a tick is the minimum of\n\n"
      "    ½ ξᵀ H ξ − rᵀ ξ + Σ φ_i(b_i − a_iᵀ ξ),  H = M/h² + B/h + K,\n"
      "    r = M V/h + B V + F − b_M,  a_i = [r_i × n_i; n_i],\n\n"
      "with the inertia M and its velocity terms b_M, the model F, K, B of the "
      "coupling and applied wrench, and a row for each pair of convex pieces "
      "within reach and for each corner where they are flush: the distance d_i "
      "along n_i does not fall below the skin, φ_i(x) = ½ k max(0, x)² with "
      "k = 1e9 N/m and b_i = min(δ, d_i) − d_i. A row that has lost skin leads "
      "back at 20 mm/s with at most 200 N; pieces that overlap are led out at "
      "that speed with 3 N together. No contact makes energy: a_iᵀ ξ <= 0 "
      "wherever a row that holds pushes. Without rows it is "
      "`RigidToolDynamics.step` with the coupling alone. A fast motion is "
      "divided, so that nothing is passed through.\n\n"
      "As in SAP (Castro et al., \"An Unconstrained Convex Formulation of "
      "Compliant Contact\", 2023), contact is a convex problem of one implicit "
      "step. Threads that share a stepper take turns.");
  stepper
      .def(
          nb::init<nb::handle, nb::handle, nb::handle, const ToolInertia&,
                   const CouplingGains&, const PoseVector&, double>(),
          nb::arg("tool").none(), nb::arg("objects").none(),
          nb::arg("skin_m").none(), nb::arg("dynamics"), nb::arg("gains"),
          nb::arg("q_HT"), nb::arg("period_s"),
          nb::sig("def __init__(self, tool: "
                  "drake_haptics.geometry.decomposition.decompose."
                  "Decomposition | ConvexPieces, objects: collections.abc."
                  "Sequence[drake_haptics.geometry.decomposition.decompose."
                  "Decomposition | ConvexPieces], skin_m: "
                  "numpy.typing.ArrayLike, dynamics: RigidToolDynamics, gains: "
                  "CouplingGains, q_HT: numpy.typing.ArrayLike, period_s: "
                  "float) -> None"),
          "Puts all objects at rest at the identity pose.\n\n"
          "Args:\n"
          "    tool: Pieces of the tool.\n"
          "    objects: Pieces of each object.\n"
          "    skin_m: (num_objects,) distance δ that the tool keeps from each "
          "object, m. What is to fit needs more clearance than it.\n"
          "    dynamics: Inertia of the tool.\n"
          "    gains: Spring and damper of the coupling, and their limits.\n"
          "    q_HT: (7,) pose of the tool in the handle.\n"
          "    period_s: Duration h of a tick, s.\n\n"
          "Raises:\n"
          "    ValueError: not decompositions, not one skin for each object, "
          "or a number is out of range.")
      .def_prop_ro(
          "num_objects",
          [](const SharedStepper& self) {
            return self.constants().num_objects();
          },
          "How many objects there are.")
      .def("set_object_pose", &SharedStepper::SetObjectPose, nb::arg("i"),
           nb::arg("X_WO").none(), nb::arg("V_WO") = Vec6(Vec6::Zero()),
           nb::sig("def set_object_pose(self, i: int, X_WO: "
                   "drake_haptics.common.pose_like.PoseLike, V_WO: "
                   "numpy.typing.ArrayLike = ...) -> None"),
           "Poses object i at the next tick's beginning.\n\n"
           "Args:\n"
           "    i: Which object.\n"
           "    X_WO: Its pose, as a tracker takes it.\n"
           "    V_WO: (6,) spatial velocity [rad/s; m/s] of its frame in the "
           "tick. Defaults to rest.\n\n"
           "Raises:\n"
           "    ValueError: not a pose, or not finite; the object stays where "
           "it is.\n"
           "    IndexError: no such object.")
      .def(
          "step", &SharedStepper::Step, nb::arg("q_WT"), nb::arg("V_WT"),
          nb::arg("q_WH"), nb::arg("V_WH"),
          nb::arg("F_applied_To_W") = Vec6(Vec6::Zero()),
          nb::sig("def step(self, q_WT: numpy.typing.ArrayLike, V_WT: "
                  "numpy.typing.ArrayLike, q_WH: numpy.typing.ArrayLike, V_WH: "
                  "numpy.typing.ArrayLike, F_applied_To_W: "
                  "numpy.typing.ArrayLike = ...) -> ConstraintStepResult"),
          "Advances the tool by a tick.\n\n"
          "Args:\n"
          "    q_WT, V_WT: (7,) pose [qw qx qy qz x y z] and (6,) spatial "
          "velocity [rad/s; m/s] of the tool.\n"
          "    q_WH, V_WH: The same of the handle.\n"
          "    F_applied_To_W: (6,) all other wrenches on the tool, [torque; "
          "force] at To in W, its weight among them. Defaults to zero.\n\n"
          "Raises:\n"
          "    ValueError: a value is not finite; what was learnt stays.")
      .def("reset", &SharedStepper::Reset,
           "Forgets what earlier ticks found; the objects stay.")
      .def("__deepcopy__", [](const SharedStepper& self,
                              nb::handle) { return SharedStepper(self); })
      .def("__copy__",
           [](const SharedStepper& self) { return SharedStepper(self); })
      .def("__repr__", [](const SharedStepper& self) {
        return nb::str("ConstraintStepper({}, period {} s)")
            .format(Counted(static_cast<std::size_t>(
                                self.constants().num_objects()),
                            "object"),
                    self.constants().settings().period);
      });
}

}  // namespace drake_haptics
