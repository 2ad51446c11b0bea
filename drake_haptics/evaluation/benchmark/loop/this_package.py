"""Runs the loop of this package: through Drake's Simulator, and in the core alone."""

from __future__ import annotations

import time
import warnings

import numpy as np
from pydrake.systems.framework import Context, Diagram, DiagramBuilder, EventStatus
from pydrake.systems.primitives import Demultiplexer, PassThrough, TrajectorySource
from pydrake.trajectories import PiecewisePolynomial

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.benchmark.loop.problem import LoopCourse, LoopProblem
from drake_haptics.evaluation.measuring.timing import clock_interval, steady_memory
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.run import make_simulator
from drake_haptics.systems.device.haptic_device import HapticDevice

# A row of the recording begins by this share of a tick early, so that round-off of the
# time never shows the one before.
_EARLY = 1e-3


class ThisLoop:
    """The systems of `AddHapticLoop`, from a device's reading to its wrench.

    Behind the device port is a recording in Drake's own `TrajectorySource`.
    """

    def __init__(self, problem: LoopProblem, *, paced: bool = False):
        """Builds the loop.

        Args:
            problem: What it is given.
            paced: Whether ticks that are timed wait for the clock, as for a device;
                else each follows the one before at once.
        """
        self._problem = problem
        self._paced = paced
        site = find_device_site(problem.scene)
        device = HapticDevice(
            _make_recording(problem),
            period_s=problem.motion.period_s,
            max_force_N=site.max_force_N,
            max_torque_Nm=site.max_torque_Nm,
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SceneWarning)
            self._haptic = BuildHapticDiagram(problem.scene, device=device)

    @property
    def haptic(self) -> HapticDiagram:
        """What is run."""
        return self._haptic

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        return _observe(self._problem, self._haptic)

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        n = len(self._problem.motion)
        simulator = make_simulator(self._haptic)
        begins: list[float] = []
        ends: list[float] = []
        clock = time.perf_counter
        pace = RealTimePacer(self._problem.motion.period_s) if self._paced else None

        def note(context: Context) -> EventStatus:
            ends.append(clock())
            # Waiting belongs to no tick.
            if pace is not None:
                pace.wait()
            begins.append(clock())
            return EventStatus.Succeeded()

        with steady_memory():
            simulator.Initialize()
            simulator.set_monitor(note)
            begins.append(clock())
            simulator.AdvanceTo((n - 0.5) * self._problem.motion.period_s)
        # The last tick ends where the run does, not where a tick does.
        return (np.array(ends) - begins[: len(ends)])[:n]


class NativeLoop:
    """What that loop computes, in the core alone: no Drake, no Python between ticks."""

    def __init__(self, problem: LoopProblem):
        self._problem = problem
        scene, coupling = problem.scene, problem.scene.coupling
        p_TTcm, I_TTcm_T = problem.mass_properties()
        start = np.concatenate([problem.X_WG[0], np.zeros(6)])
        self._arguments = (
            problem.tool.core,
            [part.core for part in problem.objects],
            np.array([pose_to_vector(X) for X in problem.X_WO]),
            scene.contact.tolerance_m,
            _core.RigidToolDynamics(scene.tool.mass_kg, p_TTcm, I_TTcm_T),
            _core.CouplingGains(
                coupling.stiffness_N_per_m,
                coupling.damping_Ns_per_m,
                coupling.rotational_stiffness_Nm_per_rad,
                coupling.rotational_damping_Nms_per_rad,
            ),
            pose_to_vector(problem.X_HT),
            scene.contact.stiffness_N_per_m,
            scene.contact.damping_Ns_per_m,
            problem.motion.period_s,
            np.hstack([problem.motion.X_WH, problem.motion.V_WH]),
            start,
        )

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        states, num_contacts, nearest, _ = _core.run_tool_loop(*self._arguments)
        poses = np.vstack([self._arguments[-1][:7], states[:-1, :7]])
        nearest_m = np.where(num_contacts > 0, nearest, 0.0)
        force_N = self._problem.spring_force(poses[:, 4:])
        return LoopCourse(poses, num_contacts, nearest_m, force_N)

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        seconds: np.ndarray = _core.run_tool_loop(*self._arguments)[3]
        return seconds - clock_interval()


def _observe(problem: LoopProblem, haptic: HapticDiagram) -> LoopCourse:
    """Reads each tick's contacts, which costs nothing twice but is not timed."""
    simulator = make_simulator(haptic)
    root = simulator.get_context()
    tool, query = haptic.loop.haptic_tool, haptic.loop.contact_query
    pose, contacts = tool.GetOutputPort("X_WT"), query.GetOutputPort("contacts")
    tool_context = tool.GetMyContextFromRoot(root)
    query_context = query.GetMyContextFromRoot(root)
    rows: list[np.ndarray] = []
    counts: list[tuple[int, float]] = []

    def note(context: Context) -> EventStatus:
        rows.append(np.array(pose.Eval(tool_context)))
        found = contacts.Eval(query_context)
        counts.append((len(found), min(found.distance.tolist(), default=0.0)))
        return EventStatus.Succeeded()

    n = len(problem.motion)
    simulator.Initialize()
    note(root)
    simulator.set_monitor(note)
    simulator.AdvanceTo((n - 0.5) * problem.motion.period_s)
    X_WT = np.array(rows[:n])
    num_contacts, nearest_m = np.array(counts[:n]).T
    force_N = problem.spring_force(X_WT[:, 4:])
    return LoopCourse(X_WT, num_contacts.astype(int), nearest_m, force_N)


def _make_recording(problem: LoopProblem) -> Diagram:
    """Returns a backend of a device whose handle moves as recorded."""
    motion = problem.motion
    rows = np.hstack([motion.X_WH, motion.V_WH])
    begin_s = motion.times_s - _EARLY * motion.period_s
    # The last row holds until the end.
    breaks = np.append(begin_s, motion.times_s[-1] + motion.period_s)
    trajectory = PiecewisePolynomial.ZeroOrderHold(
        breaks, np.vstack([rows, rows[-1]]).T
    )
    builder = DiagramBuilder()
    source = builder.AddNamedSystem("recording", TrajectorySource(trajectory))
    parts = builder.AddNamedSystem("parts", Demultiplexer([7, 6]))
    builder.Connect(source.get_output_port(), parts.get_input_port())
    ignored = builder.AddNamedSystem("ignored", PassThrough(6))
    builder.ExportInput(ignored.get_input_port(), "F_Ho_W_rendered")
    builder.ExportOutput(parts.get_output_port(0), "X_WH")
    builder.ExportOutput(parts.get_output_port(1), "V_WH")
    return builder.Build()
