"""Moves a scene's tool as it was recorded and reads what the contacts answer."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from pydrake.systems.framework import Context

from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.run import make_simulator
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.device.replayed_handle import ReplayedHandle


@dataclass(frozen=True, eq=False)
class ToolReplay:
    """What the contacts of a scene answer to a recorded motion, at its n ticks.

    Attributes:
        F_Tool_W: (n, 6) wrench [τ; f] at the tool's origin in the world, N·m and N: of
            contact and of all effects that push the tool.
        distance: (n,) of the deepest contact, m; infinite where there is none nearer
            than the scene's tolerance.
    """

    F_Tool_W: np.ndarray
    distance: np.ndarray


@dataclass(frozen=True)
class ReplayedTick:
    """A tick of a scene at which its tool is where a motion has it.

    Attributes:
        row: Of the motion.
        haptic: The scene's diagram.
        root: Its context, to be read.
    """

    row: int
    haptic: HapticDiagram
    root: Context


def replay_tool(scene: Scene, motion: RecordedMotion) -> ToolReplay:
    """Returns what a scene's contacts answer when its tool moves as recorded.

    The loop is open: however wrong an answer is, the tool goes on as it did. At a tick
    of the motion at which the scene has none the last answer holds, as in the loop.

    Args:
        scene: Whose answer is wanted.
        motion: From any run.

    Raises:
        SceneError: The scene cannot be built.
        MeshError: A mesh cannot be treated.
    """
    F_Tool_W = np.zeros((len(motion), 6))
    distance = np.full(len(motion), np.inf)
    for tick in walk_tool(scene, motion):
        # All rows up to the scene's next tick.
        F_Tool_W[tick.row :] = _read_wrench(tick)
        distance[tick.row :] = _read_distance(tick, scene.contact.tolerance_m)
    return ToolReplay(F_Tool_W, distance)


def walk_tool(scene: Scene, motion: RecordedMotion) -> Iterator[ReplayedTick]:
    """Yields each tick of a scene whose handle and tool move as recorded.

    All systems do what they do in a run, but the tool's state is set before each tick.
    """
    haptic = _build(scene, motion)
    simulator = make_simulator(haptic)
    root = simulator.get_mutable_context()
    tool = haptic.loop.haptic_tool.GetMyMutableContextFromRoot(root)
    states = np.hstack([motion.X_WTool, motion.V_WTool])
    for row, number in motion.find_ticks(haptic.period_s):
        if row > 0:
            simulator.AdvanceTo(number * haptic.period_s)
        tool.SetDiscreteState(0, states[row])
        if row == 0:
            simulator.Initialize()
        yield ReplayedTick(row, haptic, root)


def _build(scene: Scene, motion: RecordedMotion) -> HapticDiagram:
    """Returns a scene's diagram with the handle of a recorded motion."""
    site = find_device_site(scene)
    device = HapticDevice(
        ReplayedHandle(motion.X_WH, motion.V_WH, motion.period_s),
        period_s=1.0 / scene.device.rate_hz,
        max_force_N=site.max_force_N,
        max_torque_Nm=site.max_torque_Nm,
    )
    with warnings.catch_warnings():
        # Whether its coupling is stable is measured.
        warnings.simplefilter("ignore", SceneWarning)
        return BuildHapticDiagram(scene, device=device)


def _read_wrench(tick: ReplayedTick) -> np.ndarray:
    """Returns the wrench (6,) of all that pushes the tool but the coupling."""
    total = np.zeros(6)
    for name, port in tick.haptic.loop.wrench_sources.items():
        if name != "coupling":
            context = port.get_system().GetMyContextFromRoot(tick.root)
            total += port.Eval(context)[:6]
    return total


def _read_distance(tick: ReplayedTick, tolerance_m: float) -> float:
    port = tick.haptic.loop.contacts
    contacts = port.Eval(port.get_system().GetMyContextFromRoot(tick.root))
    nearest = min(contacts.distance.tolist(), default=np.inf)
    # Braking looks further.
    return nearest if nearest < tolerance_m else np.inf
