#include "bind/bind_tracker.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "bind/bind.h"
#include "bind/bind_contact.h"
#include "bind/bind_depth.h"
#include "bind/bind_pose.h"
#include "bind/bind_real_array.h"
#include "bind/bind_shapes.h"
#include "bind/bind_trajectory.h"
#include "bind/bind_turn.h"
#include "tracker/contact_tracker.h"

namespace nb = nanobind;

// Documentation of the arguments that both trackers' constructors share.
#define DRAKE_HAPTICS_DEPTH_ARGUMENTS                                         \
  "Args:\n"                                                                   \
  "    depth: Depth of two pieces in overlap: `tracked` walks from the last " \
  "answer, and so does not pop through a thin plate; `global` is the "        \
  "smallest depth over all features of both surfaces, and costs more. Both "  \
  "hold a piece that has passed behind a surface until it comes back.\n"      \
  "    max_walk_steps: Bound on the steps of a walk from feature to "         \
  "feature (paper, 5.2.3), at least 1. Where it ends a walk, the status is "  \
  "`BOUNDED`, and the depth may be too large, never too small.\n\n"

namespace drake_haptics {

// The public Decomposition holds the core's Decomposition as its attribute
// `core`.
DecompositionPtr ToDecomposition(nb::handle value, const std::string& name) {
  DecompositionPtr decomposition;
  const nb::object core = nb::getattr(value, "core", value);
  if (core.is_none() || !nb::try_cast(core, decomposition)) {
    throw std::invalid_argument(name + " must be a Decomposition, got " +
                                TypeName(value) + "; see decompose()");
  }
  return decomposition;
}

std::vector<DecompositionPtr> ToDecompositions(nb::handle values) {
  if (!PySequence_Check(values.ptr()) || nb::len(values) == 0) {
    throw std::invalid_argument(
        "objects must be a list of one Decomposition or more, got " +
        (PySequence_Check(values.ptr()) ? std::string("an empty one")
                                        : TypeName(values)));
  }
  std::vector<DecompositionPtr> decompositions;
  for (const nb::handle value : values) {
    const std::string name =
        "objects[" + std::to_string(decompositions.size()) + "]";
    decompositions.push_back(ToDecomposition(value, name));
  }
  return decompositions;
}

namespace {

DepthSearch ToDepthSearch(nb::handle depth, nb::handle max_walk_steps) {
  const bool is_global = IsGlobalDepth(depth);
  int steps = 0;
  if (PyBool_Check(max_walk_steps.ptr()) ||
      !nb::try_cast(max_walk_steps, steps) || steps < 1) {
    throw std::invalid_argument(
        "max_walk_steps must be a whole number of at least 1, is " +
        nb::cast<std::string>(nb::repr(max_walk_steps)));
  }
  return {is_global, steps};
}

class PairTracker : public SharedTracker {
 public:
  PairTracker(nb::handle A, nb::handle B, nb::handle tolerance,
              nb::handle depth, nb::handle max_walk_steps)
      : SharedTracker({ToDecomposition(A, "A"),
                       {ToDecomposition(B, "B")},
                       ToReal(tolerance, "tolerance"),
                       ToDepthSearch(depth, max_walk_steps)}) {}

  ContactSet Query(nb::handle X_WA_value, nb::handle X_WB_value) {
    const Pose X_WA = ToPose(X_WA_value, "X_WA");
    const Pose X_WB = ToPose(X_WB_value, "X_WB");
    ContactSet contacts;
    const Turn turn(&mutex_, Turn::Gil::kHold);
    tracker_.SetObjectPose(0, X_WB);
    tracker_.Query(X_WA, &contacts);
    return contacts;
  }

  ContactTrajectory QueryTrajectory(nb::handle X_WA_value,
                                    nb::handle X_WB_value) {
    const PoseSeries X_WA(X_WA_value, "X_WA");
    const PoseSeries X_WB(X_WB_value, "X_WB");
    return QueryEach(CommonSize(X_WA, X_WB), X_WA,
                     [&](std::size_t k, ContactTracker* tracker) {
                       tracker->SetObjectPose(0, X_WB[k]);
                     });
  }
};

}  // namespace

void SharedTracker::SetTolerance(nb::handle value) {
  const double tolerance = ToReal(value, "tolerance");
  const Turn turn(&mutex_, Turn::Gil::kHold);
  ++changes_;
  tracker_.SetTolerance(tolerance);
}

SceneTracker::SceneTracker(nb::handle tool, nb::handle objects,
                           nb::handle tolerance, nb::handle depth,
                           nb::handle max_walk_steps)
    : SharedTracker({ToDecomposition(tool, "tool"), ToDecompositions(objects),
                     ToReal(tolerance, "tolerance"),
                     ToDepthSearch(depth, max_walk_steps)}) {}

void SceneTracker::SetObjectPose(nb::handle place, nb::handle X_WO_value) {
  const Pose X_WO = ToPose(X_WO_value, "X_WO");
  const int i = ToObjectIndex(place, tracker_.num_objects());
  const Turn turn(&mutex_, Turn::Gil::kHold);
  ++changes_;
  tracker_.SetObjectPose(i, X_WO);
}

ContactSet SceneTracker::Query(nb::handle X_WT_value,
                               nb::handle tolerance_value) {
  const Pose X_WT = ToPose(X_WT_value, "X_WT");
  const auto tolerance = ToOptionalReal(tolerance_value, "tolerance");
  ContactSet contacts;
  const Turn turn(&mutex_, Turn::Gil::kHold);
  tracker_.Query(X_WT, tolerance.value_or(tracker_.tolerance()), &contacts);
  return contacts;
}

ContactTrajectory SceneTracker::QueryTrajectory(nb::handle X_WT_value) {
  const PoseSeries X_WT(X_WT_value, "X_WT");
  return QueryEach(X_WT.size(), X_WT, [](std::size_t, ContactTracker*) {});
}

namespace {

void BindContactTrajectory(nb::module_& m) {
  nb::class_<ContactTrajectory> trajectory(
      m, "ContactTrajectory",
      "The contacts of a tracker at each of k poses: read-only columns over "
      "all n contacts, pose after pose, and a sequence of `ContactSet`. "
      "Immutable.");
  DefSequence(
      &trajectory, [](const ContactTrajectory& t) { return t.seconds.size(); },
      [](const ContactTrajectory& t, std::size_t k) { return t.At(k); }, "k",
      "def __iter__(self) -> collections.abc.Iterator[ContactSet]",
      "The contacts at pose k.");
  trajectory.def("__repr__", [](const ContactTrajectory& t) {
    return nb::str("ContactTrajectory({}, {})")
        .format(Counted(t.seconds.size(), "pose"),
                Counted(t.contacts.size(), "contact"));
  });
  constexpr auto kItems = &ContactTrajectory::contacts;
  DefContactColumns<kItems>(&trajectory);
  DefPieceColumns<kItems>(&trajectory);
  DefNumbers<&ContactTrajectory::start>(
      &trajectory, "start",
      "(k + 1,) int64: the contacts at pose i are the rows start[i] to "
      "start[i + 1] of the columns.");
  DefNumbers<&ContactTrajectory::seconds>(
      &trajectory, "seconds",
      "(k,) time that each query took inside the core, s.");
  DefFrozenCopy(&trajectory);
}

// Defines the members that both trackers have.
template <typename Tracker>
void DefTracker(nb::class_<Tracker>* tracker) {
  tracker
      ->def_prop_rw(
          "tolerance", &Tracker::Tolerance, &Tracker::SetTolerance,
          nb::arg("tolerance").none(),
          "Distance up to which there are contacts, m. It may be changed "
          "between two queries; the tracker goes on from its last answer.\n\n"
          "Raises:\n"
          "    ValueError: negative or not finite.")
      .def_prop_ro(
          "depth",
          [](const Tracker& self) {
            return DepthName(self.constants().depth().is_global);
          },
          "'tracked' or 'global'.")
      .def_prop_ro(
          "max_walk_steps",
          [](const Tracker& self) {
            return self.constants().depth().max_walk_steps;
          },
          "Bound on the steps of a walk from feature to feature.")
      .def("reset", &Tracker::Reset, "Forgets what earlier queries found.");
  DefCopy(tracker);
}

void BindContactTracker(nb::module_& m) {
  nb::class_<PairTracker> tracker(
      m, "ContactTracker",
      "All contacts of two decomposed bodies A and B, each query starting from "
      "the last one's answer (paper, sections 3 and 5.3): one for each pair of "
      "convex pieces nearer than the tolerance. Seams between pieces are not "
      "felt, and a piece that was pressed in stays in contact until it comes "
      "out the way it went in.\n\n"
      "A pose is a (4, 4) rigid matrix, a `RigidTransform`, or a (7,) vector "
      "[qw qx qy qz x y z]; lengths in m. A ValueError leaves the tracker as "
      "it was. Threads that share a tracker take turns.");
  tracker
      .def(nb::init<nb::handle, nb::handle, nb::handle, nb::handle,
                    nb::handle>(),
           nb::arg("A").none(), nb::arg("B").none(),
           nb::arg("tolerance").none(), nb::arg("depth").none() = "tracked",
           nb::arg("max_walk_steps").none() = WalkBounds{}.max_steps,
           nb::sig("def __init__(self, A: "
                   "drake_haptics.geometry.decomposition.decompose."
                   "Decomposition | ConvexPieces, B: "
                   "drake_haptics.geometry.decomposition.decompose."
                   "Decomposition | ConvexPieces, tolerance: "
                   "float, depth: typing.Literal['tracked', 'global'] = "
                   "'tracked', max_walk_steps: int = 1024) -> None"),
           "Tracks the contacts of A and B up to `tolerance` "
           "(m).\n\n" DRAKE_HAPTICS_DEPTH_ARGUMENTS
           "Raises:\n    ValueError: not decompositions, the tolerance is "
           "negative or not finite, no such depth, or max_walk_steps below 1.")
      .def("query", &PairTracker::Query, nb::arg("X_WA").none(),
           nb::arg("X_WB").none(),
           nb::sig(
               "def query(self, X_WA: drake_haptics.common.pose_like.PoseLike, "
               "X_WB: drake_haptics.common.pose_like.PoseLike) -> ContactSet"),
           "`ContactSet` of the bodies at the poses X_WA and X_WB.\n\n"
           "Raises:\n    ValueError: a pose is not finite or not rigid.")
      .def("query_trajectory", &PairTracker::QueryTrajectory,
           nb::arg("X_WA").none(), nb::arg("X_WB").none(),
           nb::sig(
               "def query_trajectory(self, X_WA: "
               "drake_haptics.common.pose_like.PoseLike, X_WB: "
               "drake_haptics.common.pose_like.PoseLike) -> ContactTrajectory"),
           "Contacts of k queries in turn, in one call without the GIL.\n\n"
           "Args:\n"
           "    X_WA: (k, 4, 4) or (k, 7) poses of A in turn, or one pose if A "
           "rests.\n"
           "    X_WB: poses of B, likewise.\n\n"
           "Raises:\n"
           "    ValueError: a pose is not finite or not rigid, or numbers of "
           "poses differ; then no query is made.")
      .def("__repr__", [](const PairTracker& self) {
        return nb::str("ContactTracker(tolerance={} m)")
            .format(self.Tolerance());
      });
  DefTracker(&tracker);
}

void BindSceneTracker(nb::module_& m) {
  nb::class_<SceneTracker> tracker(
      m, "SceneTracker",
      "All contacts of a moving tool with many objects at once: a "
      "`ContactTracker` in which A is the tool and B each object. Objects are "
      "posed one by one and stay there, so that those at rest cost nothing.");
  tracker
      .def(nb::init<nb::handle, nb::handle, nb::handle, nb::handle,
                    nb::handle>(),
           nb::arg("tool").none(), nb::arg("objects").none(),
           nb::arg("tolerance").none(), nb::arg("depth").none() = "tracked",
           nb::arg("max_walk_steps").none() = WalkBounds{}.max_steps,
           nb::sig("def __init__(self, tool: "
                   "drake_haptics.geometry.decomposition.decompose."
                   "Decomposition | ConvexPieces, objects: collections.abc."
                   "Sequence[drake_haptics.geometry.decomposition.decompose."
                   "Decomposition | "
                   "ConvexPieces], tolerance: float, depth: typing.Literal["
                   "'tracked', 'global'] = 'tracked', max_walk_steps: int = "
                   "1024) -> None"),
           "Tracks the contacts of `tool` with `objects`, all at the identity "
           "pose, up to `tolerance` (m).\n\n" DRAKE_HAPTICS_DEPTH_ARGUMENTS
           "Raises:\n    ValueError: not decompositions, no objects, the "
           "tolerance is negative or not finite, no such depth, or "
           "max_walk_steps below 1.")
      .def_prop_ro("num_objects",
                   [](const SceneTracker& self) {
                     return self.constants().num_objects();
                   })
      .def("set_object_pose", &SceneTracker::SetObjectPose, nb::arg("i"),
           nb::arg("X_WO").none(),
           nb::sig("def set_object_pose(self, i: int, X_WO: "
                   "drake_haptics.common.pose_like.PoseLike) -> None"),
           "Poses object i.\n\n"
           "Raises:\n    ValueError: not a pose; the object stays where it is."
           "\n    IndexError: no such object.")
      .def("query", &SceneTracker::Query, nb::arg("X_WT").none(),
           nb::arg("tolerance") = nb::none(),
           nb::sig("def query(self, X_WT: "
                   "drake_haptics.common.pose_like.PoseLike, "
                   "tolerance: float | None = None) -> ContactSet"),
           "`ContactSet` of the tool at the pose X_WT. A `tolerance` (m) "
           "smaller than the tracker's limits the query to contacts up to "
           "that, for less work; each query may have its own.\n\n"
           "Raises:\n"
           "    ValueError: the pose is not finite or not rigid, or the "
           "tolerance not within 0 and the tracker's.")
      .def("query_trajectory", &SceneTracker::QueryTrajectory,
           nb::arg("X_WT").none(),
           nb::sig(
               "def query_trajectory(self, X_WT: "
               "drake_haptics.common.pose_like.PoseLike) -> ContactTrajectory"),
           "Contacts of k queries in turn, in one call without the GIL; the "
           "objects rest.\n\n"
           "Args:\n"
           "    X_WT: (k, 4, 4) or (k, 7) poses of the tool in turn.\n\n"
           "Raises:\n"
           "    ValueError: a pose is not finite or not rigid; then no query "
           "is made.")
      .def("__repr__", [](const SceneTracker& self) {
        return nb::str("SceneTracker({}, tolerance={} m)")
            .format(Counted(self.constants().num_objects(), "object"),
                    self.Tolerance());
      });
  DefTracker(&tracker);
}

}  // namespace

void BindTracker(nb::module_& m) {
  BindContactTrajectory(m);
  BindContactTracker(m);
  BindSceneTracker(m);
}

}  // namespace drake_haptics
