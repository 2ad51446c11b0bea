"""Records how handle and tool move in a run, and moves a scene's tool the same way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.systems.framework import Context, OutputPort

from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import make_simulator, run
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.device.replayed_handle import ReplayedHandle

# Numbers of ticks at the same time differ by round-off.
_SAME_TICK = 1e-6


@dataclass(frozen=True, eq=False)
class RecordedMotion:
    """Motion of handle H and tool in the world W, tick by tick.

    Poses are [qw qx qy qz x y z], m; velocities are [ω; v] of the frame's origin in the
    world, rad/s and m/s. Row k is the state that the updates of tick k + 1 of the run
    read.

    Attributes:
        period_s: Period of the ticks, s.
        X_WT: (n, 7) poses of the tool.
        V_WT: (n, 6) spatial velocities of the tool.
        X_WH: (n, 7) poses of the handle.
        V_WH: (n, 6) spatial velocities of the handle.
    """

    period_s: float
    X_WT: np.ndarray
    V_WT: np.ndarray
    X_WH: np.ndarray
    V_WH: np.ndarray

    def __len__(self) -> int:
        """Returns the number of ticks n."""
        return len(self.X_WT)

    @property
    def times_s(self) -> np.ndarray:
        """(n,) times of the rows, s; the first is 0."""
        return self.period_s * np.arange(len(self))

    def find_ticks(self, period_s: float) -> list[tuple[int, int]]:
        """Returns the rows at which a loop has a new tick, each with its number."""
        numbers = (self.times_s / period_s + _SAME_TICK).astype(int)
        rows = np.flatnonzero(np.diff(numbers, prepend=-1))
        return list(zip(rows.tolist(), numbers[rows].tolist(), strict=True))

    def sample(self, period_s: float) -> RecordedMotion:
        """Returns the rows at which a loop of another period, s, has a new tick."""
        rows = [row for row, _ in self.find_ticks(period_s)]
        return self._take(rows, max(period_s, self.period_s))

    def cut(self, first: int, end: int) -> RecordedMotion:
        """Returns the rows from `first` up to, but not including, `end`."""
        return self._take(list(range(first, end)), self.period_s)

    def _take(self, rows: list[int], period_s: float) -> RecordedMotion:
        arrays = (self.X_WT, self.V_WT, self.X_WH, self.V_WH)
        return RecordedMotion(period_s, *(array[rows] for array in arrays))


def choose_duration(scene: Scene, longest_s: float = 4.0) -> float:
    """Returns the time of one lap of the hand's path, at most `longest_s`, s.

    Some thousand ticks show the effect of a setting. If the hand does not move, the
    tool comes to rest meanwhile.
    """
    return min(make_hand_path(scene.hand.path).duration_s or longest_s, longest_s)


def record_motion(scene: Scene, duration_s: float | None = None) -> RecordedMotion:
    """Runs a scene in its simulated hand and records how handle and tool move.

    The same scene gives the same motion, bit for bit. The duration defaults to that of
    `choose_duration`.

    Raises:
        SceneError, MeshError: The scene cannot be built.
        RunError: The loop diverges.
    """
    if duration_s is None:
        duration_s = choose_duration(scene)
    haptic = build_without_scene_warnings(scene)
    loop = haptic.loop
    ports = [
        loop.haptic_tool.GetOutputPort("X_WT"),
        loop.haptic_tool.GetOutputPort("V_WT"),
        loop.device.GetOutputPort("X_WH"),
        loop.device.GetOutputPort("V_WH"),
    ]
    readers = [(port, port.get_system().GetMyContextFromRoot) for port in ports]
    rows: list[np.ndarray] = []

    def note(root: Context) -> None:
        rows.append(np.concatenate([port.Eval(find(root)) for port, find in readers]))

    run(haptic, duration_s, on_tick=note)
    X_WT, V_WT, X_WH, V_WH = np.split(np.array(rows), [7, 13, 20], axis=1)
    return RecordedMotion(haptic.period_s, X_WT, V_WT, X_WH, V_WH)


@dataclass(frozen=True, eq=False)
class ToolReplay:
    """The wrenches of a scene's contacts along a recorded motion, at its n ticks.

    Attributes:
        F_To_W: (n, 6) wrench [τ; f] at the tool's origin in the world, N·m and N: of
            contact and of all effects that push the tool.
        distance: (n,) distance of the deepest contact, m; infinite beyond the
            tolerance.
    """

    F_To_W: np.ndarray
    distance: np.ndarray


def replay_tool(scene: Scene, motion: RecordedMotion) -> ToolReplay:
    """Returns the wrenches of a scene's contacts when its tool moves as recorded.

    All systems work as in a run, but the tool's state is set before each tick, so that
    the loop is open and a wrong wrench does not change the motion. At a row of the
    motion without a tick of the scene, the last wrench is held, as in the loop.

    Raises:
        SceneError, MeshError: The scene cannot be built.
    """
    site = find_device_site(scene)
    device = HapticDevice(
        ReplayedHandle(motion.X_WH, motion.V_WH, motion.period_s),
        period_s=1.0 / scene.device.rate_hz,
        max_force_N=site.max_force_N,
        max_torque_Nm=site.max_torque_Nm,
    )
    haptic = build_without_scene_warnings(scene, device)
    loop = haptic.loop
    sources = [port for name, port in loop.wrench_sources.items() if name != "coupling"]
    simulator = make_simulator(haptic)
    root = simulator.get_mutable_context()
    tool = loop.haptic_tool.GetMyMutableContextFromRoot(root)
    states = np.hstack([motion.X_WT, motion.V_WT])
    F_To_W = np.zeros((len(motion), 6))
    distance = np.full(len(motion), np.inf)
    for row, number in motion.find_ticks(haptic.period_s):
        if row > 0:
            simulator.AdvanceTo(number * haptic.period_s)
        tool.SetDiscreteState(0, states[row])
        if row == 0:
            simulator.Initialize()
        # All rows until the scene's next tick.
        F_To_W[row:] = sum(_read(port, root)[:6] for port in sources)
        nearest = _read(loop.contacts, root).least_distance
        # Braking searches farther.
        distance[row:] = nearest if nearest < scene.contact.tolerance_m else np.inf
    return ToolReplay(F_To_W, distance)


def _read(port: OutputPort, root: Context) -> Any:
    return port.Eval(port.get_system().GetMyContextFromRoot(root))
