#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <tuple>

#include "bind/bind.h"
#include "bind/bind_trajectory.h"
#include "tool/tool_loop.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

using DecompositionPtr = std::shared_ptr<const Decomposition>;
using States = Eigen::Matrix<double, Eigen::Dynamic, 13, Eigen::RowMajor>;
using Poses = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;
using Run =
    std::tuple<States, Eigen::VectorXi, Eigen::VectorXd, Eigen::VectorXd>;

ContactTracker PosedTracker(DecompositionPtr tool,
                            const std::vector<DecompositionPtr>& objects,
                            const Poses& q_WO, double tolerance) {
  if (q_WO.rows() != static_cast<Eigen::Index>(objects.size())) {
    throw std::invalid_argument("q_WO must have one row for each object");
  }
  ContactTracker tracker(std::move(tool), objects, tolerance);
  for (int i = 0; i < tracker.num_objects(); ++i) {
    tracker.SetObjectPose(i, PoseFromVector(q_WO.row(i).transpose(), "q_WO"));
  }
  return tracker;
}

// Runs one tick after the other, and times each.
Run RunToolLoop(ToolLoop* loop, double tolerance, const States& handle,
                const ToolStateVector& start) {
  const Eigen::Index n = handle.rows();
  Run run{States(n, 13), Eigen::VectorXi(n), Eigen::VectorXd(n),
          Eigen::VectorXd(n)};
  auto& [states, num_contacts, nearest, seconds] = run;
  ToolState state = ToToolState(start);
  RunTrajectory(static_cast<std::size_t>(n), [&](std::size_t i) {
    const auto k = static_cast<Eigen::Index>(i);
    const PoseVector q_WH = handle.row(k).head<7>();
    const Vec6 V_WH = handle.row(k).tail<6>();
    const Clock::time_point begin = Clock::now();
    loop->Step(q_WH, V_WH, &state);
    seconds[k] = SecondsSince(begin);
    states.row(k) = ToVector(state).transpose();
    const ContactSet& found = loop->contacts();
    num_contacts[k] = static_cast<int>(found.contacts.size());
    nearest[k] = std::min(tolerance, found.least_distance());
  });
  return run;
}

}  // namespace

void BindToolLoop(nb::module_& m) {
  m.def(
      "run_tool_loop",
      [](DecompositionPtr tool, const std::vector<DecompositionPtr>& objects,
         const Poses& q_WO, double tolerance, const ToolInertia& dynamics,
         const CouplingGains& gains, const PoseVector& q_HT, double stiffness,
         double damping, double h, const States& handle,
         const ToolStateVector& start) {
        ToolLoop loop(
            PosedTracker(std::move(tool), objects, q_WO, tolerance),
            {dynamics, gains, q_HT,
             std::vector<ContactMaterial>(objects.size(), {stiffness, damping}),
             h});
        const nb::gil_scoped_release release;
        return RunToolLoop(&loop, tolerance, handle, start);
      },
      nb::arg("tool"), nb::arg("objects"), nb::arg("q_WO"),
      nb::arg("tolerance"), nb::arg("dynamics"), nb::arg("gains"),
      nb::arg("q_HT"), nb::arg("stiffness"), nb::arg("damping"), nb::arg("h"),
      nb::arg("handle"), nb::arg("start"),
      "Computes a haptic loop without effects, tick after tick, without Drake "
      "and without the GIL: query, shared stiffness, penalty force, coupling, "
      "and the tool's implicit step.\n\n"
      "Args:\n"
      "    tool, objects: pieces of the tool and of each object; the objects "
      "rest.\n"
      "    q_WO: (m, 7) poses [qw qx qy qz x y z] of the objects.\n"
      "    tolerance: distance up to which contacts push, m.\n"
      "    dynamics, gains, q_HT: inertia of the tool, gains of its coupling, "
      "and its pose (7,) in the handle.\n"
      "    stiffness, damping: gains of every contact, N/m and N·s/m.\n"
      "    h: duration of a tick, s.\n"
      "    handle: (n, 13) pose (7) and spatial velocity (6) of the handle at "
      "each tick.\n"
      "    start: (13,) pose and spatial velocity of the tool before the first "
      "tick.\n\n"
      "Returns:\n"
      "    The tool's state (n, 13) after each tick; the number of contacts "
      "(n,) and the smallest distance (n,), m, at its beginning, the tolerance "
      "without contacts; and the time (n,) that the tick took, s.\n\n"
      "Raises:\n"
      "    ValueError: poses or gains are out of range.");
}

}  // namespace drake_haptics
