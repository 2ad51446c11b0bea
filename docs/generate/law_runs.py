"""The same tools, solids and handles under either law of contact."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from constraint_rig import SKIN_M, ConstraintLoop
from contact_samples import decomposed
from hollow_block import height, hollow_block, spike
from press_cells import TOOLS
from press_rig import (
    COUPLING,
    GAINS,
    LARGEST_FORCE_N,
    LONGEST_TRAVEL_M,
    PERIOD_S,
    PenaltyLoop,
    Press,
    Tick,
    move_handle,
    sample_presses,
)
from press_tools import MODELS, PressTool, make_tool, make_tools
from solid_surface import Surface

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh

# What a hand is held still or slides with, below what the coupling yields at.
STEADY_N = 0.5 * LARGEST_FORCE_N
HOLLOW_X_M = np.linspace(-9e-3, 9e-3, 37)


class Loop(Protocol):
    """A tool held against a solid under one of the laws."""

    def tick(self, q_WH: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns X_WT (7,), contact's wrench (6,) on it, the hand's force (3,)."""

    def calc_work(self) -> np.ndarray:
        """Returns the energy that contact had given and held at each tick (n,), J."""


class Penalty:
    """The penalty law with the builder's default gains.

    Attributes:
        ticks: What was found at each tick.
    """

    def __init__(
        self,
        tool: PressTool,
        solid: _core.ConvexPieces,
        q_WT: np.ndarray,
        range_m: float = GAINS["default"].tolerance_m,
    ) -> None:
        self._gains = replace(GAINS["default"], tolerance_m=range_m)
        self._loop = PenaltyLoop(tool, solid, self._gains, q_WT)
        self.ticks: list[Tick] = []

    def tick(self, q_WH: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns X_WT (7,), contact's wrench (6,) on it, the hand's force (3,)."""
        tick = self._loop.tick(q_WH)
        self.ticks.append(tick)
        return tick.state[:7], tick.F_contact_W, -tick.F_coupling_W[3:]

    def calc_work(self) -> np.ndarray:
        """Returns the energy that contact had given and held at each tick (n,), J."""
        F = np.array([tick.F_contact_W for tick in self.ticks])
        V = np.array([tick.state[7:] for tick in self.ticks])
        # The trapezoidal rule is exact for a spring.
        power = np.einsum("ij,ij->i", 0.5 * (F[:-1] + F[1:]), V[1:])
        work = np.concatenate([[0.0], np.cumsum(power) * PERIOD_S])
        k, tolerance = self._gains.stiffness_N_per_m, self._gains.tolerance_m
        clusters = [tick.clusters for tick in self.ticks]
        held = [0.5 * k * c.compression @ (tolerance - c.distance) for c in clusters]
        return work + np.array(held, dtype=float)


class Constraint:
    """The constraint law with its default skin."""

    def __init__(
        self,
        tool: PressTool,
        solid: _core.ConvexPieces,
        q_WT: np.ndarray,
        range_m: float = SKIN_M,
        period_s: float = PERIOD_S,
    ) -> None:
        self._loop = ConstraintLoop(
            tool, [solid], q_WT, skin_m=range_m, gains=COUPLING, period_s=period_s
        )

    def tick(self, q_WH: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns X_WT (7,), contact's wrench (6,) on it, the hand's force (3,)."""
        result = self._loop.tick(q_WH)
        push_N = result.lambda_N @ result.contacts.nhat_BA_W.reshape(-1, 3)
        F = np.concatenate([np.zeros(3), push_N])
        return self._loop.q_WT, F, result.F_Ho_W_commanded[3:]

    def calc_work(self) -> np.ndarray:
        """Returns the energy that contact had given at each tick (n,), J."""
        return np.cumsum([0.0, *self._loop.work_J])


LAWS: dict[str, Callable[..., Loop]] = {"penalty": Penalty, "constraint": Constraint}
# Distance from which on a law pushes, by default, m.
RANGE_M = {"penalty": GAINS["default"].tolerance_m, "constraint": SKIN_M}


@dataclass
class Run:
    """The motion of a tool while a handle moved, tick by tick."""

    phases: np.ndarray
    q_WT: np.ndarray  # (n, 7)
    F_contact_W: np.ndarray  # (n, 6)
    f_hand_W: np.ndarray  # (n, 3), N
    time_us: np.ndarray  # (n,)
    made_J: float  # Most that contact gave beyond what it had been given.


def run_handle(
    loop: Loop, press: Press, held: int = 0, period_s: float = PERIOD_S
) -> Run:
    """Runs a press, or until the hand has been still for some ticks."""
    script = move_handle(press, period_s)
    phase, q_WH = next(script)
    ticks: list[tuple] = []
    still = 0
    while not held or still < held:
        start = time.perf_counter()
        found = loop.tick(q_WH)
        ticks.append((phase, *found, 1e6 * (time.perf_counter() - start)))
        still += phase == "hold"
        if held and still:
            continue
        try:
            phase, q_WH = script.send(float(np.linalg.norm(found[2])))
        except StopIteration:
            break
    work_J = loop.calc_work()
    made_J = float((work_J - np.minimum.accumulate(work_J)).max())
    return Run(*map(np.array, zip(*ticks, strict=True)), made_J)


@dataclass(frozen=True, eq=False)
class Place:
    """A press on a solid, and a tool that has room where it starts."""

    solid: str
    tool: PressTool
    surface: Surface
    pieces: _core.ConvexPieces
    press: Press


def list_places(
    motion: str, points: int, solids: Sequence[str], *, steady: bool = False
) -> Iterator[Place]:
    """Yields places on shipped solids, their tools in turn.

    Args:
        motion: One of press_rig.MOTIONS.
        points: Number of points on each solid; a tool may have no room at some.
        solids: Names among press_cells.SHIPPED.
        steady: Whether to press with STEADY_N, not with the largest force.
    """
    tools = make_tools()
    for name in solids:
        mesh = load_mesh(MODELS / f"{name}.obj", scale=1.0)
        surface, pieces = Surface(mesh), decompose(mesh).core
        for i in range(points):
            tool = tools[TOOLS[i % len(TOOLS)]]
            [press] = sample_presses(mesh, tool, motion, [i], 0)
            if steady:
                press = replace(press, stop_N=STEADY_N)
            if _has_room(tool, pieces, press.q_WH(0.0, 0.0)):
                yield Place(name, tool, surface, pieces, press)


def list_hollow_places(*, slide: bool = False) -> Iterator[Place]:
    """Yields places in a hollow of eight facets, for a spike; or one, to slide from."""
    tool = make_tool(_mesh_of(*spike()), [[0, 0, -1]])
    surface, pieces = Surface(_mesh_of(*hollow_block())), decomposed(*hollow_block())
    up, along = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    for x in [-7.5e-3] if slide else HOLLOW_X_M:
        press = Press(
            p_W=np.array([x, 3e-4, float(height(x))]),
            nhat_W=up,
            push_W=-up,
            slide_W=along * slide,
            R_WT=np.eye(3),
            p_TP=np.zeros(3),
            speed_m_per_s=0.1,
            stop_N=STEADY_N,
            stop_m=LONGEST_TRAVEL_M,
        )
        yield Place("hollow", tool, surface, pieces, press)


def _mesh_of(V: np.ndarray, F: np.ndarray) -> Mesh:
    return Mesh.from_arrays(V, F.astype("i4"))


def _has_room(tool: PressTool, solid: _core.ConvexPieces, q_WT: np.ndarray) -> bool:
    tracker = _core.SceneTracker(tool.core, [solid], GAINS["default"].tolerance_m)
    return len(tracker.query(q_WT)) == 0
