#include <nanobind/stl/vector.h>

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
#include "bind/bind_trajectory.h"
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
                const PoseVector& q_HT, double period, nb::handle coefficient,
                double break_away)
      : stepper_(
            ToDecomposition(tool, "tool"), ToDecompositions(objects),
            {dynamics, gains, CheckedPose(q_HT, "q_HT"), period,
             ToNumbers(skin, "skin_m"),
             RowFriction(ToNumbers(coefficient, "coefficient"), break_away)}) {}
  SharedStepper(const SharedStepper& other) : stepper_(other.Copy()) {}

  // For members that never change.
  const ConstraintStepper& constants() const { return stepper_; }

  void SetGains(const CouplingGains& gains) {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    stepper_.SetGains(gains);
  }

  ConstraintStepper Copy() const {
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    return stepper_;
  }

  void SetObjectPose(nb::handle place, nb::handle X_WO_value,
                     const Vec6& V_WO) {
    const Pose X_WO = ToPose(X_WO_value, "X_WO");
    const int i = ToObjectIndex(place, stepper_.num_objects());
    const Turn turn(&mutex_, Turn::Gil::kHold);
    stepper_.SetObjectPose(i, X_WO, V_WO);
  }

  Result Step(const PoseVector& q_WT, const Vec6& V_WT, const PoseVector& q_WH,
              const Vec6& V_WH, const Vec6& F_applied, nb::handle anchors) {
    Result result;
    std::vector<double> numbers = ToNumbers(anchors, "anchors");
    if (numbers.empty()) numbers.resize(constants().num_anchors());
    const Turn turn(&mutex_, Turn::Gil::kHold);
    const Clock::time_point start = Clock::now();
    stepper_.Step({q_WT, V_WT}, q_WH, V_WH, F_applied, numbers, &result);
    // The search and the step are one: all of it counts as the query.
    result.contacts.query_seconds = SecondsSince(start);
    return result;
  }

  AutoDiffVector Differentiate(const AutoDiffVector& state,
                               const AutoDiffVector& q_WH,
                               const AutoDiffVector& V_WH,
                               const AutoDiffVector& F_applied,
                               const std::vector<AutoDiffVector>& X_WO,
                               const std::vector<AutoDiffVector>& V_WO) {
    const std::size_t count = stepper_.num_objects();
    if (X_WO.size() != count || V_WO.size() != count) {
      throw std::invalid_argument(
          "X_WO and V_WO must have one entry for each object");
    }
    const auto x = ToScalars<13>(state, "state");
    ConstraintTick tick{{x.head<7>(), x.tail<6>()},
                        ToScalars<7>(q_WH, "q_WH"),
                        ToScalars<6>(V_WH, "V_WH"),
                        ToScalars<6>(F_applied, "F_applied_To_W"),
                        {},
                        {},
                        CommonNumDerivatives(state, q_WH, V_WH, F_applied)};
    for (std::size_t i = 0; i < count; ++i) {
      CommonNumDerivatives(state, X_WO[i], V_WO[i]);
      tick.q_WO.push_back(ToScalars<7>(X_WO[i], "X_WO"));
      tick.V_WO.push_back(ToScalars<6>(V_WO[i], "V_WO"));
    }
    const Turn turn(&mutex_, Turn::Gil::kHold);
    const ConstraintTickGradient found = stepper_.Differentiate(tick);
    VectorOf<AutoDiff> all(19 + 6 * count);
    all.head<19>() << found.next.q_WT, found.next.V_WT, found.F_To_W;
    for (std::size_t i = 0; i < count; ++i) {
      all.segment<6>(19 + 6 * i) = found.F_Oo_W[i];
    }
    return ToAutoDiffVector(all, tick.num_derivatives);
  }

  void Reset() {
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    stepper_.Reset();
  }

 private:
  static std::vector<double> ToNumbers(nb::handle value, const char* name) {
    const RealArray array(value, name);
    if (array.ndim() != 1) {
      throw std::invalid_argument(std::string(name) +
                                  " must have one dimension, has shape " +
                                  array.shape_text());
    }
    std::vector<double> numbers;
    for (Py_ssize_t i = 0; i < array.shape(0); ++i) {
      numbers.push_back(array[i]);
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
      "Result of one tick of a `ConstraintStepper`. Immutable.");
  DefFrozenCopy(&result);
  result
      .def_prop_ro(
          "q_WT", [](const Result& r) { return r.next.q_WT; },
          "(7,) pose [qw qx qy qz x y z] of the tool at the tick's end.")
      .def_prop_ro(
          "V_WT", [](const Result& r) { return r.next.V_WT; },
          "(6,) spatial velocity [rad/s; m/s] of the tool at the tick's end.")
      .def_ro(
          "F_Ho_W_commanded", &Result::F_Ho_W_commanded,
          "(6,) [torque; force] of the coupling on the handle at Ho in W, at "
          "the tick's beginning, as from `joined_coupling_wrench`.")
      .def_ro(
          "contacts", &Result::contacts,
          "`ContactSet` of the rows that push, ordered by object and pieces. A "
          "flush pair has several.")
      .def_ro("friction", &Result::friction,
              "`FrictionStep` of `contacts`, which take the place of clusters.")
      .def_prop_ro(
          "F_Oo_W", [](const Result& r) { return ToRows(r.F_Oo_W); },
          "(num_objects, 6) [torque; force] of contact on each object at the "
          "origin of its frame, in W, friction included.")
      .def_ro(
          "hessian", &Result::hessian,
          "(6, 6) slope of the step's forces by the tool's motion, [N·m; N] by "
          "[rad; m]: A = M/h² + B/h + K + Σ k a aᵀ over rows that push, and "
          "the slope of friction. A change dF of the wrench on the tool "
          "changes its motion by A⁻¹ dF and V_WT by A⁻¹ dF / h.")
      .def_ro("contact_stiffness", &Result::contact_stiffness,
              "(6, 6) the rows' part of `hessian`, Σ k a aᵀ.")
      .def_ro("num_rows", &Result::num_rows,
              "Number of rows within reach, including those that do not push.")
      .def_ro("num_substeps", &Result::num_substeps,
              "Number of parts of a divided fast motion, at least 1.")
      .def_ro("num_iterations", &Result::num_iterations,
              "Number of iterations of Newton's method, over all solutions of "
              "the tick.")
      .def_ro("is_bounded", &Result::is_bounded,
              "Whether a bound on iterations or parts ended the tick, so that "
              "the tool moved less than it should.")
      .def_ro("least_distance_m", &Result::least_distance,
              "Smallest distance of the tool to an object at the tick's "
              "beginning, m; infinite where none is within reach.")
      .def_ro("is_apart", &Result::is_apart,
              "Whether no pieces touch or overlap at the tick's beginning. "
              "Otherwise the tool is led out at a bounded speed.")
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
      "Contact as a constraint: in each tick, a rigid tool on a virtual "
      "coupling stays a skin away from all objects.\n\n"
      "The motion ξ = [θ; t] of To in a tick is the minimum of\n\n"
      "    ½ ξᵀ H ξ − rᵀ ξ + Σ φ_i(b_i − a_iᵀ ξ),  H = M/h² + B/h + K,\n"
      "    r = M V/h + B V + F − b_M,  a_i = [r_i × n_i; n_i],\n\n"
      "with the inertia M and its velocity terms b_M, the model F, K, B of the "
      "coupling and applied wrench, and a row for each pair of convex pieces "
      "within reach and for each corner where they are flush: the distance d_i "
      "along n_i does not fall below the skin, φ_i(x) = ½ k max(0, x)² with k "
      "= 1e9 N/m and b_i = min(δ, d_i) − d_i. A row that has lost skin leads "
      "back at 20 mm/s with at most 200 N; pieces that overlap are led out at "
      "that speed with at most 3 N in total. No contact makes energy: a_iᵀ ξ "
      "<= 0 wherever a row that holds pushes. Without rows it is "
      "`RigidToolDynamics.step` with the coupling alone. A fast motion is "
      "divided, so that nothing is passed through.\n\n"
      "As in SAP (Castro et al., \"An Unconstrained Convex Formulation of "
      "Compliant Contact\", 2023), contact is a convex problem of one implicit "
      "step. Threads that share a stepper take turns.");
  stepper
      .def(
          nb::init<nb::handle, nb::handle, nb::handle, const ToolInertia&,
                   const CouplingGains&, const PoseVector&, double, nb::handle,
                   double>(),
          nb::arg("tool").none(), nb::arg("objects").none(),
          nb::arg("skin_m").none(), nb::arg("dynamics"), nb::arg("gains"),
          nb::arg("q_HT"), nb::arg("period_s"),
          nb::arg("coefficient") = nb::tuple(), nb::arg("break_away_m") = 1e-4,
          nb::sig("def __init__(self, tool: "
                  "drake_haptics.geometry.decomposition.decompose."
                  "Decomposition | ConvexPieces, objects: collections.abc."
                  "Sequence[drake_haptics.geometry.decomposition.decompose."
                  "Decomposition | ConvexPieces], skin_m: "
                  "numpy.typing.ArrayLike, dynamics: RigidToolDynamics, gains: "
                  "CouplingGains, q_HT: numpy.typing.ArrayLike, period_s: "
                  "float, coefficient: numpy.typing.ArrayLike = (), "
                  "break_away_m: float = 1e-4) -> None"),
          "Puts all objects at rest at the identity pose.\n\n"
          "Args:\n"
          "    tool: Pieces of the tool.\n"
          "    objects: Pieces of each object.\n"
          "    skin_m: (num_objects,) distance δ that the tool keeps from each "
          "object, m. A tool that must fit somewhere needs more clearance than "
          "that.\n"
          "    dynamics: Inertia of the tool.\n"
          "    gains: Spring and damper of the coupling, and their limits.\n"
          "    q_HT: (7,) pose of the tool in the handle.\n"
          "    period_s: Duration h of a tick, s.\n"
          "    coefficient: (num_objects,) coefficient of friction μ with each "
          "object. Defaults to none.\n"
          "    break_away_m: Displacement of the tool before it slides, m. "
          "Defaults to 0.1 mm.\n\n"
          "Raises:\n"
          "    ValueError: not decompositions, not one skin or coefficient for "
          "each object, or a number is out of range.")
      .def_prop_ro(
          "num_anchors",
          [](const SharedStepper& self) {
            return self.constants().num_anchors();
          },
          "Number of values of the friction anchors: 8 for each "
          "object, or 0.")
      .def_prop_ro(
          "num_objects",
          [](const SharedStepper& self) {
            return self.constants().num_objects();
          },
          "Number of objects.")
      .def("set_gains", &SharedStepper::SetGains, nb::arg("gains"),
           "Changes the gains of the coupling, from the next tick on.")
      .def("set_object_pose", &SharedStepper::SetObjectPose, nb::arg("i"),
           nb::arg("X_WO").none(), nb::arg("V_WO") = Vec6(Vec6::Zero()),
           nb::sig("def set_object_pose(self, i: int, X_WO: "
                   "drake_haptics.common.pose_like.PoseLike, V_WO: "
                   "numpy.typing.ArrayLike = ...) -> None"),
           "Poses object i at the next tick's beginning.\n\n"
           "Args:\n"
           "    i: Index of the object.\n"
           "    X_WO: Pose of the object, as a tracker takes it.\n"
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
          nb::arg("anchors") = nb::tuple(),
          nb::sig("def step(self, q_WT: numpy.typing.ArrayLike, V_WT: "
                  "numpy.typing.ArrayLike, q_WH: numpy.typing.ArrayLike, V_WH: "
                  "numpy.typing.ArrayLike, F_applied_To_W: "
                  "numpy.typing.ArrayLike = ..., anchors: "
                  "numpy.typing.ArrayLike = ()) -> ConstraintStepResult"),
          "Advances the tool by a tick.\n\n"
          "Args:\n"
          "    q_WT, V_WT: (7,) pose [qw qx qy qz x y z] and (6,) spatial "
          "velocity [rad/s; m/s] of the tool.\n"
          "    q_WH, V_WH: Pose and spatial velocity of the handle, likewise.\n"
          "    F_applied_To_W: (6,) sum of all other wrenches on the tool, "
          "[torque; force] at To in W, its weight among them. Defaults to "
          "zero.\n"
          "    anchors: (num_anchors,) `friction.next_state` of the last tick. "
          "Defaults to the anchors of a tool that has touched nothing.\n\n"
          "Raises:\n"
          "    ValueError: a value is not finite, or the number of anchors "
          "differs; the stepper stays as it was.")
      .def("differentiate", &SharedStepper::Differentiate, nb::arg("state"),
           nb::arg("q_WH"), nb::arg("V_WH"), nb::arg("F_applied_To_W"),
           nb::arg("X_WO"), nb::arg("V_WO"),
           "Advances the tool by a tick with derivatives (step_gradient.h).\n\n"
           "Args:\n"
           "    state: (13,) pose and spatial velocity of the tool.\n"
           "    q_WH, V_WH: (7,) and (6,) pose and spatial velocity of the "
           "handle.\n"
           "    F_applied_To_W: (6,) sum of all other wrenches on the tool.\n"
           "    X_WO, V_WO: (7,) pose and (6,) spatial velocity of each "
           "object.\n\n"
           "Returns:\n"
           "    (19 + 6 num_objects,): the state at the tick's end, the wrench "
           "of contact on the tool at its origin at the tick's beginning, and "
           "the wrench on each object at its origin, in W.\n\n"
           "Raises:\n"
           "    ValueError: a value is not finite, or numbers of objects or of "
           "variables differ.")
      .def("reset", &SharedStepper::Reset,
           "Forgets what earlier ticks found; the objects stay.");
  DefCopy(&stepper);
  stepper.def("__repr__", [](const SharedStepper& self) {
    return nb::str("ConstraintStepper({}, period {} s)")
        .format(Counted(self.constants().num_objects(), "object"),
                self.constants().settings().period);
  });
}

}  // namespace drake_haptics
