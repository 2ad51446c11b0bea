"""Makes the scenes of the benchmark: those of the paper's Table 1, and larger ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from drake_haptics._core import SceneTracker
from drake_haptics.evaluation.benchmark.pairs import RATE_HZ, rotation, unit
from drake_haptics.evaluation.models import (
    check_folder,
    cut_shape,
    find_sources,
    load_machine_room,
    load_model,
    wrench_path,
)
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose

_AWAY_M = 0.010
_DEEP_M = 0.0005
_SLIDE_M = 0.010
_SWAY_RAD = 0.1
_SECONDS = 1.0
_SEARCH_STEP_M = 0.002


@dataclass(frozen=True)
class SceneProblem:
    """The queries of a scene for all libraries.

    Attributes:
        X_WO: (k, 4, 4) poses of the objects, at rest.
        motions: Motions of the tool, each (n, 4, 4) poses a millisecond apart.
        tolerance_m: Distance up to which contacts are found, m.
    """

    name: str
    tool: Decomposition
    objects: list[Decomposition]
    X_WO: np.ndarray
    motions: list[np.ndarray]
    tolerance_m: float = 0.002

    @property
    def num_triangles(self) -> int:
        """Triangles of all meshes."""
        meshes = [self.tool, *self.objects]
        return sum(len(d.mesh.triangles) for d in meshes)

    @property
    def num_pieces(self) -> tuple[int, int]:
        """Convex pieces of the tool and of all objects."""
        return len(self.tool.pieces), sum(len(d.pieces) for d in self.objects)


@dataclass(frozen=True)
class SceneAnswers:
    """A library's answers along a motion.

    Attributes:
        num_contacts: (n,) pairs of pieces within the tolerance.
        nearest_m: (n,) smallest signed distance of any, at most the tolerance, m.
        seconds: (n,) time of each tick inside the library, s.
    """

    num_contacts: np.ndarray
    nearest_m: np.ndarray
    seconds: np.ndarray


def make_touches(
    tool: Decomposition, target: Decomposition, count: int, seed: int
) -> list[np.ndarray]:
    """Returns motions that touch the object from random sides, identical on every call.

    Within a second the tool approaches from 10 mm away, presses 0.5 mm beyond first
    touch, slides 10 mm sideways and back while it sways by 0.1 rad, and leaves, all
    below 0.1 m/s and 1 rad/s.
    """
    rng = np.random.default_rng(seed)
    search = SceneTracker(tool, [target], _SEARCH_STEP_M)
    return [_touch(tool, target, search, rng) for _ in range(count)]


def _touch(
    tool: Decomposition,
    target: Decomposition,
    search: SceneTracker,
    rng: np.random.Generator,
) -> np.ndarray:
    R_WT = rotation(unit(rng.normal(size=3)), -rng.uniform(0, 2 * np.pi))
    way_W = unit(rng.normal(size=3))
    side_W = unit(np.cross(way_W, rng.normal(size=3)))
    # A random point of the tool approaches a random point of the target.
    p_ToolP, p_WQ = (rng.choice(body.mesh.vertices) for body in (tool, target))
    start_W = p_WQ - R_WT @ p_ToolP
    touch_m = _first_touch(search, R_WT, start_W, way_W, _size(tool) + _size(target))

    phase = np.linspace(0, 2 * np.pi, round(_SECONDS * RATE_HZ))
    press = np.clip(1.5 * np.sin(phase / 2), 0, 1)
    press = press**2 * (3 - 2 * press)
    along_m = touch_m + _AWAY_M - (_AWAY_M + _DEEP_M) * press
    sway = np.sin(phase)
    X_WT = np.tile(np.eye(4), (len(phase), 1, 1))
    for X, along, s in zip(X_WT, along_m, sway, strict=True):
        R_sway = rotation(way_W, -_SWAY_RAD * s)
        X[:3, :3] = R_sway @ R_WT
        # Swaying turns the tool about that point.
        X[:3, 3] = p_WQ + along * way_W + _SLIDE_M * s * side_W - X[:3, :3] @ p_ToolP
    return X_WT


def _first_touch(
    search: SceneTracker,
    R_WT: np.ndarray,
    start_W: np.ndarray,
    way_W: np.ndarray,
    far_m: float,
) -> float:
    """Returns the offset along `way_W` at which the tool first touches from afar, m."""
    X_WT = np.eye(4)
    X_WT[:3, :3] = R_WT
    along_m = far_m
    while along_m > -far_m:
        X_WT[:3, 3] = start_W + along_m * way_W
        nearest_m = search.query(X_WT).least_distance
        if np.isfinite(nearest_m):
            return along_m - nearest_m
        along_m -= _SEARCH_STEP_M / 2
    raise AssertionError("a point of one mesh on a point of the other always touches")


def _size(body: Decomposition) -> float:
    return float(np.linalg.norm(body.mesh.report.extent))


def scene_makers(
    motions: int, meshes: Path | None = None
) -> dict[str, Callable[[], SceneProblem]]:
    """Returns scene name -> a function that makes it, each with a number of motions.

    Real meshes (see `MODELS`) that are missing in the folder are replaced by the
    package's shapes, except the armadillo.

    Raises:
        HapticsError: The folder has none of them.
    """
    check_folder(meshes)
    pairs = [
        ("spoon on cup", "Spoon", "Cup"),
        ("torus on torus", "Torus", "Torus"),
        ("torus on hammer", "Torus", "Hammer"),
        ("spoon on organ", "Spoon", "Digestive System"),
        ("spoon on armadillo", "Spoon", "Armadillo"),
    ]
    makers: dict[str, Callable[[], SceneProblem]] = {
        name: partial(_touch_model, name, tool, target, meshes, motions)
        for name, tool, target in pairs
        if find_sources(target, meshes)
    }
    makers["peg in hole"] = partial(_peg_in_hole, motions)
    makers["wrench in machine room"] = partial(_machine_room, motions)
    return makers


def _touch_model(
    name: str, tool: str, target: str, meshes: Path | None, motions: int
) -> SceneProblem:
    """Returns a model that touches another one, as real meshes if there are any."""
    pieces, others = (
        decompose(load_model(model, find_sources(model, meshes)[-1], meshes))
        for model in (tool, target)
    )
    ways = make_touches(pieces, others, motions, seed=len(name))
    return SceneProblem(name, pieces, [others], np.eye(4)[None], ways)


def _peg_in_hole(motions: int) -> SceneProblem:
    peg, torus = (cut_shape(name) for name in ("peg", "torus"))
    phase = np.linspace(0, 2 * np.pi, 1000)
    inside = np.clip(1.5 * np.sin(phase / 2), 0, 1)
    ways = []
    for k in range(motions):
        # Down through the hole, once around its wall 0.2 mm deep, and up again. The
        # hole is 44 mm wide, the peg 24 mm.
        X = np.tile(np.eye(4), (len(phase), 1, 1))
        aside_m = 0.0102 * np.clip(3 * inside - 2, 0, 1)
        X[:, 0, 3] = aside_m * np.cos(phase + k)
        X[:, 1, 3] = aside_m * np.sin(phase + k)
        X[:, 2, 3] = 0.020 - 0.065 * np.clip(2 * inside, 0, 1)
        ways.append(X)
    return SceneProblem("peg in hole", peg, [torus], np.eye(4)[None], ways)


def _machine_room(motions: int) -> SceneProblem:
    room = load_machine_room()
    return SceneProblem(
        name="wrench in machine room",
        tool=cut_shape("wrench"),
        objects=[placed.pieces for placed in room],
        X_WO=np.array([placed.X_WO for placed in room]),
        motions=[wrench_path(3000)] * min(motions, 1),
    )
