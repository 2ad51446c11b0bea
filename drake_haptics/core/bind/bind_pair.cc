#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "bind/bind.h"
#include "bind/bind_contact.h"
#include "bind/bind_depth.h"
#include "bind/bind_pose.h"
#include "bind/bind_real_array.h"
#include "bind/bind_trajectory.h"
#include "bind/bind_turn.h"
#include "pair/convex_pair.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using PolytopePtr = std::shared_ptr<const Polytope>;

PolytopePtr ToPolytope(nb::handle value, const char* name) {
  PolytopePtr polytope;
  if (value.is_none() || !nb::try_cast(value, polytope)) {
    throw std::invalid_argument(std::string(name) +
                                " must be a ConvexPolytope, got " +
                                TypeName(value));
  }
  return polytope;
}

// The contact of a pair at each pose of a trajectory.
struct PairTrajectory {
  std::vector<Contact> contacts;
  std::vector<double> seconds;
};

// Two polytopes and the state of their query.
class ConvexPair {
 public:
  ConvexPair(nb::handle A, nb::handle B, nb::handle depth)
      : A_(ToPolytope(A, "A")),
        B_(ToPolytope(B, "B")),
        is_global_(IsGlobalDepth(depth)) {}

  ConvexPair(const ConvexPair& other)
      : A_(other.A_), B_(other.B_), is_global_(other.is_global_) {
    const Turn turn(&other.mutex_, Turn::Gil::kHold);
    state_ = other.state_;
    global_ = other.global_;
  }

  const PolytopePtr& A() const { return A_; }
  const PolytopePtr& B() const { return B_; }
  const char* depth() const { return DepthName(is_global_); }

  Contact Query(nb::handle X_WA_value, nb::handle X_WB_value) {
    const Pose X_WA = ToPose(X_WA_value, "X_WA");
    const Pose X_WB = ToPose(X_WB_value, "X_WB");
    const Turn turn(&mutex_, Turn::Gil::kHold);
    return Answer(X_WA, X_WB);
  }

  PairTrajectory QueryTrajectory(nb::handle X_WA_value, nb::handle X_WB_value) {
    const PoseSeries X_WA(X_WA_value, "X_WA");
    const PoseSeries X_WB(X_WB_value, "X_WB");
    const std::size_t size = CommonSize(X_WA, X_WB);
    PairTrajectory out{std::vector<Contact>(size), std::vector<double>(size)};
    const Turn turn(&mutex_, Turn::Gil::kRelease);
    RunTrajectory(size, [&](std::size_t k) {
      const Clock::time_point start = Clock::now();
      out.contacts[k] = Answer(X_WA[k], X_WB[k]);
      out.seconds[k] = SecondsSince(start);
    });
    return out;
  }

  void Reset() {
    const Turn turn(&mutex_, Turn::Gil::kHold);
    state_ = {};
    global_.Reset();
  }

 private:
  Contact Answer(const Pose& X_WA, const Pose& X_WB) {
    const PosedPair pair{*A_, *B_, RelativePose(X_WA, X_WB)};
    return InWorld(QueryConvexPair(pair, &state_, &workspace_,
                                   is_global_ ? &global_ : nullptr),
                   X_WA);
  }

  PolytopePtr A_, B_;
  const bool is_global_;
  PairState state_;
  GlobalDepthState global_;
  PairWorkspace workspace_;
  mutable std::mutex mutex_;
};

// Mean of the middle half of many readings, which is free of interruptions and
// finer than a tick of the clock.
double ClockInterval() {
  constexpr int kReadings = 20000;
  std::vector<double> intervals(kReadings);
  for (double& interval : intervals) {
    const Clock::time_point start = Clock::now();
    interval = SecondsSince(start);
  }
  std::sort(intervals.begin(), intervals.end());
  const auto begin = intervals.begin() + kReadings / 4;
  const auto end = intervals.end() - kReadings / 4;
  return std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
}

void BindPairTrajectory(nb::module_& m) {
  nb::class_<PairTrajectory> trajectory(
      m, "PairTrajectory",
      "The contact of a `ConvexPair` at each of n poses: read-only columns, "
      "and a sequence of `Contact`. Immutable.");
  DefSequence(
      &trajectory, [](const PairTrajectory& t) { return t.contacts.size(); },
      [](const PairTrajectory& t, std::size_t k) { return t.contacts[k]; }, "k",
      "def __iter__(self) -> collections.abc.Iterator[Contact]");
  trajectory.def("__repr__", [](const PairTrajectory& t) {
    return nb::str("PairTrajectory({})")
        .format(Counted(t.contacts.size(), "pose"));
  });
  DefContactColumns<&PairTrajectory::contacts>(&trajectory);
  DefNumbers<&PairTrajectory::seconds>(
      &trajectory, "seconds",
      "(n,) time that each query took inside the core, s, including the "
      "reading of the clock (some 0.03 µs).");
  DefFrozenCopy(&trajectory);
}

}  // namespace

bool IsGlobalDepth(nb::handle depth) {
  std::string name;
  if (nb::try_cast(depth, name)) {
    if (name == "tracked") return false;
    if (name == "global") return true;
  }
  throw std::invalid_argument("depth must be 'tracked' or 'global', got " +
                              nb::cast<std::string>(nb::repr(depth)));
}

void BindConvexPair(nb::module_& m) {
  BindPairTrajectory(m);
  nb::class_<ConvexPair> pair(
      m, "ConvexPair",
      "Signed distance of two convex polytopes A and B, each query starting "
      "from the last one's answer. Apart it is the distance of the closest "
      "features. In overlap it is minus the penetration depth: `tracked` walks "
      "from the last answer to a local minimum of the depth (paper, 5.2), and "
      "so does not pop through a thin plate; `global` is the global minimum, "
      "exact and proven.\n\n"
      "A pose is a (4, 4) rigid matrix, a `RigidTransform`, or a (7,) vector "
      "[qw qx qy qz x y z]; lengths in m. A ValueError leaves the pair as it "
      "was. Threads that share a pair take turns.");
  pair.def(nb::init<nb::handle, nb::handle, nb::handle>(), nb::arg("A").none(),
           nb::arg("B").none(), nb::arg("depth").none() = "tracked",
           nb::sig("def __init__(self, A: ConvexPolytope, B: ConvexPolytope, "
                   "depth: typing.Literal['tracked', 'global'] = 'tracked') -> "
                   "None"),
           "Pairs two `ConvexPolytope`.\n\n"
           "Raises:\n    ValueError: not polytopes, or no such depth.")
      .def_prop_ro("A", &ConvexPair::A)
      .def_prop_ro("B", &ConvexPair::B)
      .def_prop_ro("depth", &ConvexPair::depth, "'tracked' or 'global'.")
      .def("query", &ConvexPair::Query, nb::arg("X_WA").none(),
           nb::arg("X_WB").none(),
           nb::sig(
               "def query(self, X_WA: drake_haptics.common.pose_like.PoseLike, "
               "X_WB: drake_haptics.common.pose_like.PoseLike) -> Contact"),
           "`Contact` of the pair at the poses X_WA and X_WB.\n\n"
           "Raises:\n    ValueError: a pose is not finite or not rigid.")
      .def(
          "query_trajectory", &ConvexPair::QueryTrajectory,
          nb::arg("X_WA").none(), nb::arg("X_WB").none(),
          nb::sig("def query_trajectory(self, X_WA: "
                  "drake_haptics.common.pose_like.PoseLike, X_WB: "
                  "drake_haptics.common.pose_like.PoseLike) -> PairTrajectory"),
          "Contacts of n queries in turn, in one call without the GIL.\n\n"
          "Args:\n"
          "    X_WA: (n, 4, 4) or (n, 7) poses of A in turn, or one pose if A "
          "rests.\n"
          "    X_WB: poses of B, likewise.\n\n"
          "Raises:\n"
          "    ValueError: a pose is not finite or not rigid, or numbers of "
          "poses differ; then no query is made.")
      .def("reset", &ConvexPair::Reset, "Forgets what earlier queries found.");
  DefCopy(&pair);
  pair.def("__repr__", [](const ConvexPair& self) {
    return nb::str("ConvexPair({}, {}, depth='{}')")
        .format(nb::cast(self.A()), nb::cast(self.B()), self.depth());
  });
  m.def("clock_interval", &ClockInterval,
        "Seconds between two readings of the clock that times queries, with "
        "nothing between them. Each timed query includes it.");
}

}  // namespace drake_haptics
