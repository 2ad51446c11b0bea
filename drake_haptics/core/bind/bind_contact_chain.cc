#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bind/bind.h"
#include "bind/bind_array.h"
#include "bind/bind_contact.h"
#include "bind/bind_joined_coupling.h"
#include "bind/bind_objects.h"
#include "bind/bind_real_array.h"
#include "bind/bind_tracker.h"
#include "tool/contact_chain.h"
#include "tool/handle_model.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using Models = std::vector<WrenchModelVector>;

// A tracker that also returns forces. Each call goes on from the results of the
// last one.
class TrackedChain : public SceneTracker {
 public:
  explicit TrackedChain(const SceneTracker& tracker) : SceneTracker(tracker) {}
  TrackedChain(const TrackedChain& other)
      : SceneTracker(other), chain_(other.CopyChain()) {}

  void SetLaw(double tolerance, std::optional<double> delta,
              const ObjectFrames& objects, const ContactMaterials& materials,
              std::shared_ptr<ContactShading> shading) {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    chain_.SetLaw({tolerance, delta, objects.frames, materials.materials,
                   std::move(shading)});
  }

  // A pose that is not a vector is queried as by any tracker.
  ContactSet Query(nb::handle X_WT, nb::handle tolerance_value) {
    PoseVector q_WT;
    if (!nb::try_cast(X_WT, q_WT)) {
      return SceneTracker::Query(X_WT, tolerance_value);
    }
    const auto tolerance = ToOptionalReal(tolerance_value, "tolerance");
    const Turn turn(&mutex_, Turn::Gil::kHold);
    Refresh();
    return chain_.FindContacts(q_WT, tolerance.value_or(tracker_.tolerance()),
                               &tracker_);
  }

  ToolStateVector StepTool(const JoinedVector<double>& joined,
                           const ToolInertia& inertia, double h,
                           const Models& others) {
    // The sum is in the order of `RigidToolDynamics.step` of [coupling,
    // contact, others].
    WrenchModel sum;
    sum += ComputeJoinedCoupling(joined).tool;
    const ToolState state = StateOf(joined);
    sum += FindWrench(state);
    for (const WrenchModelVector& other : others) sum += ToWrenchModel(other);
    return ToVector(drake_haptics::StepTool(inertia, state, sum, h));
  }

  Vec6 FindForce(const PoseVector& q_WT, const Vec6& V_WT) {
    return FindWrench({q_WT, V_WT}).F;
  }

  // The sum is in the order of `AppliedWrenches`: contact, coupling.
  Vec6 FindCoupledForce(const JoinedVector<double>& joined) {
    return FindWrench(StateOf(joined)).F + ComputeJoinedCoupling(joined).tool.F;
  }

  FrictionStep FindFriction(const StickSlipModel& friction,
                            const NumbersArg<double>& state,
                            const PoseVector& q_WT, const Vec6& V_WT) {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    if (friction.num_moving() > 0 ||
        friction.num_objects() != chain_.num_objects()) {
      throw std::invalid_argument(
          "friction must be of the chain's objects, which rest");
    }
    if (static_cast<int>(state.shape(0)) != friction.state_size()) {
      throw std::invalid_argument("state must have " +
                                  std::to_string(friction.state_size()) +
                                  " numbers");
    }
    Refresh();
    return chain_.FindFriction(friction, state.data(), {q_WT, V_WT}, &tracker_);
  }

  WrenchModelVector FindBraking(const BrakingGains& gains,
                                const PoseVector& q_WT, const Vec6& V_WT) {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    Refresh();
    return ToVector(chain_.FindBraking(gains, {q_WT, V_WT}, &tracker_));
  }

  // Returns the least distance, and the one below which contacts push, m.
  std::pair<double, double> FindDeepest() const {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    return {chain_.contacts().least_distance(), chain_.tolerance_of_law()};
  }

  // Returns the numbers of contacts and clusters, the least distance (m) and
  // the time of the query (s).
  std::tuple<std::size_t, int, double, double> Summarize(
      const ToolStateVector& state) {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    Refresh();
    chain_.FindWrench(ToToolState(state), &tracker_);
    const ContactSet& found = chain_.contacts();
    return {found.contacts.size(), chain_.num_clusters(),
            found.least_distance(), found.query_seconds};
  }

  Eigen::Matrix<double, 72, 1> FindHandleSlopes(
      const JoinedVector<double>& joined, const Models& others) {
    const ToolState state = StateOf(joined);
    WrenchModel contact;
    contact += FindWrench(state);
    for (const WrenchModelVector& other : others) {
      contact += ToWrenchModel(other);
    }
    return ToVector(
        ComputeHandleSlopes(state.q_WT.tail<3>() - joined.segment<3>(4),
                            ComputeJoinedCoupling(joined).tool, contact));
  }

 private:
  static ToolState StateOf(const JoinedVector<double>& joined) {
    return {joined.segment<7>(13), joined.segment<6>(20)};
  }

  ContactChain CopyChain() const {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    ContactChain copy = chain_;
    // The copy counts its changes from zero.
    if (changes_ != seen_changes_) copy.Forget();
    return copy;
  }

  WrenchModel FindWrench(const ToolState& state) {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    Refresh();
    return chain_.FindWrench(state, &tracker_);
  }

  // Forgets the last results after the tracker was changed or queried
  // otherwise.
  void Refresh() {
    if (changes_ != seen_changes_) chain_.Forget();
    seen_changes_ = changes_;
  }

  ContactChain chain_;
  long seen_changes_ = 0;
};

}  // namespace

void BindContactChain(nb::module_& m) {
  nb::class_<TrackedChain, SceneTracker> chain(
      m, "ContactChain",
      "A `SceneTracker` that also computes the motion of a tool on a coupling "
      "under its contacts: query, clusters, penalty force, coupling and the "
      "tool's step in one call. It keeps its last results, so that another "
      "query of the same pose costs nothing.");
  chain
      .def(nb::init<const SceneTracker&>(), nb::arg("tracker"),
           "Goes on from the state of a tracker, which stays as it is.")
      .def("set_law", &TrackedChain::SetLaw, nb::arg("tolerance"),
           nb::arg("delta").none(), nb::arg("objects"), nb::arg("materials"),
           nb::arg("shading") = nb::none(),
           "Sets the law by which contacts push.\n\n"
           "Args:\n"
           "    tolerance: distance below which contacts push, m.\n"
           "    delta: size of the octree's cells, m; None lets contacts share "
           "stiffness.\n"
           "    objects: frames of the objects, which rest.\n"
           "    materials: materials of the objects.\n"
           "    shading: `ContactShading` of the normals; None for none.")
      .def("query", &TrackedChain::Query, nb::arg("X_WT").none(),
           nb::arg("tolerance") = nb::none(),
           nb::sig("def query(self, X_WT: "
                   "drake_haptics.common.pose_like.PoseLike, "
                   "tolerance: float | None = None) -> ContactSet"),
           "As `SceneTracker.query`, but for a pose vector (7,) equal to the "
           "last one the last results are returned.")
      .def("step_tool", &TrackedChain::StepTool, nb::arg("joined"),
           nb::arg("dynamics"), nb::arg("h"), nb::arg("others"),
           "The tool's next state (13,): `RigidToolDynamics.step` under the "
           "coupling, the contacts and other wrench models, in this order.\n\n"
           "Args:\n"
           "    joined: argument of `joined_coupling_wrench`.\n"
           "    dynamics: inertia of the tool.\n"
           "    h: duration of the step, s.\n"
           "    others: other wrench models (78,).\n\n"
           "Raises:\n"
           "    ValueError: a pose is not finite, or a gain is out of range.")
      .def("find_force", &TrackedChain::FindForce, nb::arg("X_WT"),
           nb::arg("V_WT"),
           "The wrench (6,) [torque; force] of the contacts on the tool at To, "
           "N·m and N, at its pose (7,) and spatial velocity (6,).")
      .def("find_coupled_force", &TrackedChain::FindCoupledForce,
           nb::arg("joined"),
           "The sum of that wrench and the coupling's, for the argument of "
           "`joined_coupling_wrench`.")
      .def("find_friction", &TrackedChain::FindFriction, nb::arg("friction"),
           nb::arg("state"), nb::arg("X_WT"), nb::arg("V_WT"),
           "The friction of the contacts, as `StickSlipModel.step` of their "
           "clusters and wrench.\n\n"
           "Args:\n"
           "    friction: friction with the chain's objects, which rest.\n"
           "    state: (n,) state from the last tick.\n"
           "    X_WT: (7,) pose of the tool.\n"
           "    V_WT: (6,) its spatial velocity.\n\n"
           "Raises:\n"
           "    ValueError: a size does not match, or an object moves.")
      .def("find_braking", &TrackedChain::FindBraking, nb::arg("gains"),
           nb::arg("X_WT"), nb::arg("V_WT"),
           "The wrench model (78,) of `pre_contact_braking` on the tool, whose "
           "pose (7,) and spatial velocity (6,) are given.")
      .def_prop_ro("deepest", &TrackedChain::FindDeepest,
                   "Least distance of the contacts that were found last (m, "
                   "infinite without any), and the distance below which they "
                   "push, m.")
      .def("summarize", &TrackedChain::Summarize, nb::arg("state"),
           "Numbers of contacts and of clusters, the least distance (m, "
           "infinite without contacts) and the time of the query (s), for the "
           "tool in a state (13,).")
      .def("handle_slopes", &TrackedChain::FindHandleSlopes, nb::arg("joined"),
           nb::arg("others"),
           "`handle_slopes` (72,) of the coupling and of the contacts plus "
           "other wrench models, for the arguments of `step_tool`.");
  DefCopy(&chain);
}

}  // namespace drake_haptics
