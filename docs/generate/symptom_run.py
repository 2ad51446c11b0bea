"""Runs a scene and says how much of each symptom it shows."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from pydrake.systems.framework import Context, OutputPort

from drake_haptics import BuildHapticDiagram, find_scene, load_scene, run
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.scene.schema import HandPathParameters, Scene

# The end of a run, in which a hand that has stopped is at rest.
_END_S = 0.3


@dataclass(frozen=True)
class Ticks:
    """The state after each of the n ticks of a run.

    Attributes:
        period_s: Time of a tick, s.
        force_N: Force (n, 3) that the device is asked for, in the world.
        p_WT: Origin (n, 3) of the tool, m.
        p_WTd: Origin (n, 3) of the tool that the handle asks for, m.
        depth_m: Depth (n) of the deepest contact, m; below 0 where it is near only, and
            -inf without a contact.
        limited: Number of ticks at which the device's limit was met.
        tick_s: Median time that the work of a tick took, s.
    """

    period_s: float
    force_N: np.ndarray
    p_WT: np.ndarray
    p_WTd: np.ndarray
    depth_m: np.ndarray
    limited: int
    tick_s: float

    @property
    def end(self) -> slice:
        """The ticks at the end of the run."""
        return slice(-round(_END_S / self.period_s), None)

    @property
    def apart_m(self) -> np.ndarray:
        """Distance (n) of the tool from where the handle wants it, m."""
        return np.linalg.norm(self.p_WTd - self.p_WT, axis=1)


def _ripple(values: np.ndarray) -> float:
    return float(np.ptp(values, axis=0).max())


# What a table says of a run, and in which unit.
FIGURES: dict[str, Callable[[Ticks], float]] = {
    "ripple of the force on a hand at rest, N": lambda t: _ripple(t.force_N[t.end]),
    "way of the tool under a hand at rest, mm": lambda t: 1e3 * _ripple(t.p_WT[t.end]),
    "largest jump of the force in one tick, N": lambda t: float(
        np.linalg.norm(np.diff(t.force_N, axis=0), axis=1).max()
    ),
    "deepest contact, mm": lambda t: 1e3 * float(t.depth_m.max()),
    "largest force, N": lambda t: float(np.linalg.norm(t.force_N, axis=1).max()),
    "ticks in contact, %": lambda t: 100.0 * float(np.isfinite(t.depth_m).mean()),
    "ticks at the device's limit, %": lambda t: 100.0 * t.limited / len(t.depth_m),
    "tool behind the handle, at most, mm": lambda t: 1e3 * float(t.apart_m.max()),
    "tool behind a hand at rest, mm": lambda t: 1e3 * float(t.apart_m[t.end].mean()),
    "work of a tick, % of its time": lambda t: 100.0 * t.tick_s / t.period_s,
}


@dataclass(frozen=True)
class Case:
    """A shipped scene with some keys changed so that it shows a symptom.

    Attributes:
        section: Section of the page.
        scene: Name of the scene.
        figure: Key of `FIGURES`.
        provoked: Keys of the scene, and their new values.
        cure: Keys that are changed further.
        given: Keys that both have, and that the page does not name.
        motion: Description of what is special in the hand's motion.
        stop_s: Time of the waypoint at which the hand stops; never where not given.
        path: Path instead of the scene's.
        duration_s: Duration of the run, s.
    """

    section: str
    scene: str
    figure: str
    provoked: Mapping[str, Any]
    cure: Mapping[str, Any]
    given: Mapping[str, Any] = field(default_factory=dict)
    motion: str = ""
    stop_s: float | None = None
    path: HandPathParameters | None = None
    duration_s: float = 2.0

    def make_scene(self, *, cured: bool) -> Scene:
        """Returns the scene, provoked or cured."""
        scene = load_scene(find_scene(self.scene))
        if self.path is not None:
            scene.hand.path = copy.deepcopy(self.path)
        if self.stop_s is not None:
            points = scene.hand.path.waypoints
            kept = [point for point in points if point.time_s <= self.stop_s]
            scene.hand.path = HandPathParameters(periodic=False, waypoints=kept)
        changes = {**self.given, **self.provoked, **(self.cure if cured else {})}
        for key, value in changes.items():
            set_key(scene, key, value)
        return scene

    def measure(self, *, cured: bool) -> float:
        """Returns the figure of a run."""
        ticks = record(self.make_scene(cured=cured), self.duration_s)
        return FIGURES[self.figure](ticks)


def set_key(scene: Scene, key: str, value: Any) -> None:
    """Changes a key of a scene; `environment.` is each object.

    Raises:
        AttributeError: There is no such key.
    """
    head, *rest = key.split(".")
    parts = scene.environment if head == "environment" else [getattr(scene, head)]
    *between, last = rest
    for part in parts:
        for name in between:
            part = getattr(part, name)
        getattr(part, last)
        setattr(part, last, copy.deepcopy(value))


def record(scene: Scene, duration_s: float) -> Ticks:
    """Runs a scene and notes the values of each tick."""
    haptic = BuildHapticDiagram(scene)
    loop = haptic.loop
    X_HT = scene.tool.grasp.to_rigid_transform()
    coupling = loop.virtual_coupling
    eval_handle = partial(_eval, loop.device.GetOutputPort("X_WH"))
    eval_tool = partial(_eval, loop.haptic_tool.GetOutputPort("X_WT"))
    eval_wrench = partial(_eval, coupling.GetOutputPort("F_Ho_W_commanded"))
    eval_contacts = partial(_eval, loop.found_contacts)
    rows = []

    def note(root: Context) -> None:
        X_WTd = vector_to_pose(eval_handle(root)).multiply(X_HT)
        rows.append(
            [
                *eval_wrench(root)[3:],
                *eval_tool(root)[4:],
                *X_WTd.translation(),
                -eval_contacts(root).distance.min(initial=np.inf),
            ]
        )

    figures = run(haptic, duration_s, on_tick=note).to_dict()
    table = np.array(rows)
    return Ticks(
        period_s=haptic.period_s,
        force_N=table[:, :3],
        p_WT=table[:, 3:6],
        p_WTd=table[:, 6:9],
        depth_m=table[:, 9],
        limited=figures["limit_hits"],
        tick_s=1e-6 * figures["tick_us"]["median"],
    )


def _eval(port: OutputPort, root: Context) -> Any:
    return port.Eval(port.get_system().GetMyContextFromRoot(root))
