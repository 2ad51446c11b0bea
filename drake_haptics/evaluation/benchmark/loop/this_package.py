"""Runs the loop of this package, in Drake's Simulator and in the core alone."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import asdict

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import PassThrough, TrajectorySource
from pydrake.trajectories import PiecewisePolynomial

from drake_haptics import _core
from drake_haptics._core import FrameChange
from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.device.backend import DeviceBackend, DeviceCommand, DeviceReading
from drake_haptics.evaluation.benchmark.loop.problem import LoopCourse, LoopProblem
from drake_haptics.evaluation.benchmark.loop.simulated_ticks import (
    SimulatedLoop,
    observe_ticks,
)
from drake_haptics.evaluation.measuring.timing import clock_interval
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.simulation.run import make_simulator
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.framework.vector_ports import export_parts

# Share of a tick by which rows of the recording begin early, so that round-off never
# selects the previous row.
_EARLY = 1e-3


class ThisLoop(SimulatedLoop):
    """The systems of `AddHapticLoop`, from a device's reading to its wrench.

    Behind the device port is a recording in Drake's `TrajectorySource`.
    """

    def __init__(self, problem: LoopProblem, *, paced: bool = False):
        super().__init__(problem, paced=paced)
        self._haptic = build_without_scene_warnings(problem.scene, self._make_device())

    def _make_device(self) -> HapticDevice | DeviceBackend | None:
        return make_recorded_device(self._problem)

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        loop = self._haptic.loop
        return observe_ticks(
            self._problem,
            self.make_simulator(),
            loop.haptic_tool.GetOutputPort("X_WT"),
            loop.contact_query.GetOutputPort("contacts"),
        )

    def make_simulator(self) -> Simulator:
        """Returns a simulator at the beginning of the motion."""
        return make_simulator(self._haptic)


class BackendLoop(ThisLoop):
    """The whole loop with a `DeviceBackend` in Python, as users write."""

    def _make_device(self) -> DeviceBackend:
        self._backend = _RecordedBackend(self._problem)
        return self._backend

    def make_simulator(self) -> Simulator:
        """Returns a simulator at the beginning of the motion."""
        self._backend.rewind()
        return super().make_simulator()


class SceneLoop(ThisLoop):
    """The scene as in `drake-haptics run`: a simulated arm in a simulated hand."""

    def _make_device(self) -> None:
        """Leaves the device to the scene."""


class _RecordedBackend(DeviceBackend):
    """A device whose handle moves as recorded, one row per reading."""

    def __init__(self, problem: LoopProblem):
        motion = problem.motion
        X_WB = find_device_site(problem.scene).X_WB
        to_base = FrameChange(pose_to_vector(X_WB.inverse()))
        self._readings: list[DeviceReading] = []
        for tick, time_s in enumerate(motion.times_s.tolist()):
            handle = to_base.change_motion(motion.X_WH[tick], motion.V_WH[tick])
            self._readings.append(
                DeviceReading(tick, time_s, handle[:7], handle[7:], np.zeros(6))
            )
        # Building a loop reads the handle's pose, which must not advance the recording.
        self._next: Iterator[DeviceReading] = itertools.repeat(self._readings[0])

    @property
    def is_placed(self) -> bool:
        """Always True."""
        return True

    def rewind(self) -> None:
        """Returns to the first reading."""
        self._next = iter(self._readings)

    def read(self) -> DeviceReading | None:
        """Returns the next reading, or None after the last."""
        return next(self._next, None)

    def write(self, command: DeviceCommand) -> None:
        """Ignores the command."""

    def close(self) -> None:
        """Does nothing."""


class NativeLoop:
    """The computations of the loop in the core: no Drake, no Python between ticks."""

    def __init__(self, problem: LoopProblem):
        self._problem = problem
        scene = problem.scene
        start = np.concatenate([problem.X_WG[0], np.zeros(6)])
        self._arguments = (
            problem.tool.core,
            [part.core for part in problem.objects],
            np.array([pose_to_vector(X) for X in problem.X_WO]),
            scene.contact.tolerance_m,
            _core.RigidToolDynamics(scene.tool.mass_kg, *problem.mass_properties()),
            _core.CouplingGains(**asdict(scene.coupling)),
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


def make_recorded_device(problem: LoopProblem) -> HapticDevice:
    """Returns a device port with the scene's limits whose handle moves as recorded."""
    site = find_device_site(problem.scene)
    return HapticDevice(
        _make_recording(problem),
        period_s=problem.motion.period_s,
        max_force_N=site.max_force_N,
        max_torque_Nm=site.max_torque_Nm,
    )


def _make_recording(problem: LoopProblem) -> Diagram:
    motion = problem.motion
    rows = np.hstack([motion.X_WH, motion.V_WH])
    begin_s = motion.times_s - _EARLY * motion.period_s
    # The last row is held until the end.
    breaks = np.append(begin_s, motion.times_s[-1] + motion.period_s)
    trajectory = PiecewisePolynomial.ZeroOrderHold(
        breaks, np.vstack([rows, rows[-1]]).T
    )
    builder = DiagramBuilder()
    source = builder.AddNamedSystem("recording", TrajectorySource(trajectory))
    ignored = builder.AddNamedSystem("ignored", PassThrough(6))
    builder.ExportInput(ignored.get_input_port(), "F_Ho_W_rendered")
    export_parts(builder, source.get_output_port(), {"X_WH": 7, "V_WH": 6})
    return builder.Build()
