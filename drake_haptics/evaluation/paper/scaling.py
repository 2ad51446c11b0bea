"""Measures how query and force computation grow with pairs and contacts (6.3)."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import trimesh

from drake_haptics import _core
from drake_haptics._core import SceneTracker
from drake_haptics.evaluation.measuring.timing import typical
from drake_haptics.evaluation.paper.fits import LineFit, PowerFit, fit_line, fit_power
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.mesh.mesh import Mesh

NUM_TEETH = (1, 2, 4, 8, 16, 32, 64)
_TOLERANCE_M = 1e-3
_DEEP_M = 5e-4
_SPACING_M = 0.005
_ACROSS = 8
_WIDEST_M = 0.002
_PLATE_M = 0.2
_SLIDE_REPEATS = 7
_TEETH_ACROSS = (1, 2, 4, 6, 8, 12, 16)
_WIDTH_M = 0.04
_CLUSTER_M = 8e-3
# Least number of contacts; with fewer the call from Python takes most of the time.
FEWEST_FITTED = 16


@dataclass(frozen=True)
class PairScaling:
    """Median times of a whole query over the number of pairs that penetrate."""

    pairs: tuple[int, ...]
    median_us: tuple[float, ...]
    line: LineFit


def measure_pair_scaling(ticks: int) -> PairScaling:
    """Slides brushes with 1 to 64 teeth over a plate, 0.5 mm deep."""
    plate = make_plate()
    motion = plan_slide(ticks)
    brushes = [make_brush(teeth) for teeth in NUM_TEETH]
    trackers = [SceneTracker(brush, [plate], _TOLERANCE_M) for brush in brushes]
    # In turns, so that disturbances affect all brushes alike.
    seconds = np.array(
        [
            [[tracker.query(X).query_seconds for X in motion] for tracker in trackers]
            for _ in range(_SLIDE_REPEATS)
        ]
    )
    median_us = (1e6 * np.median(typical(seconds), axis=1)).tolist()
    line = fit_line(np.array(NUM_TEETH), median_us)
    return PairScaling(NUM_TEETH, tuple(median_us), line)


def make_brush(
    teeth: int, across: int = _ACROSS, spacing_m: float = _SPACING_M
) -> Decomposition:
    """Returns a tool of separate pointed teeth, with their points at z = 0.

    A tooth is convex, has eight sides and is 10 mm high. Its width is a third of the
    spacing, and at most 2 mm.
    """
    row, column = np.divmod(np.arange(teeth), across)
    places = (np.column_stack([column, row]) - (across - 1) / 2) * spacing_m
    radius_m = min(spacing_m / 3, _WIDEST_M) / 2
    angle = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    x, y = radius_m * np.cos(angle), radius_m * np.sin(angle)
    rings = [np.column_stack([x, y, np.full(8, z)]) for z in (0.003, 0.010)]
    ends = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0105)]
    tooth = trimesh.convex.convex_hull(np.vstack([*rings, ends]))
    brush: Any = trimesh.util.concatenate(
        [tooth.copy().apply_translation((x, y, 0.0)) for x, y in places]
    )
    return decompose(Mesh.from_arrays(brush.vertices, brush.faces))


def make_plate() -> Decomposition:
    """Returns a plate 200 mm wide and 20 mm thick, with its top at z = 0."""
    half_m = _PLATE_M / 2
    plate = trimesh.creation.box(
        bounds=[(-half_m, -half_m, -0.02), (half_m, half_m, 0.0)]
    )
    return decompose(Mesh.from_arrays(plate.vertices, plate.faces))


def plan_slide(ticks: int) -> np.ndarray:
    """Returns X_WT (ticks, 4, 4), once around a circle of 10 mm radius, 0.5 mm deep."""
    angle = np.linspace(0.0, 2.0 * np.pi, ticks)
    X_WT = np.tile(np.eye(4), (ticks, 1, 1))
    X_WT[:, 0, 3], X_WT[:, 1, 3] = 0.01 * np.cos(angle), 0.01 * np.sin(angle)
    X_WT[:, 2, 3] = -_DEEP_M
    return X_WT


@dataclass(frozen=True)
class ForceScaling:
    """Median times of clustering and force over contacts, for one kind of clustering.

    The method is "octree" (the paper's) or "shared". There is a force for each cluster.
    Growths are over contacts before clustering; that of times is from `FEWEST_FITTED`
    on.
    """

    method: str
    contacts: tuple[int, ...]
    forces: tuple[int, ...]
    median_us: tuple[float, ...]
    force_growth: PowerFit
    time_growth: PowerFit


def measure_force_scaling(repeats: int) -> tuple[ForceScaling, ...]:
    """Presses brushes with 1 to 256 teeth, all 40 mm wide, into a plate."""
    plate = make_plate()
    sets = [_touch(across, plate) for across in _TEETH_ACROSS]
    cluster = {
        "octree": partial(
            _core.cluster_contacts, delta=_CLUSTER_M, tolerance=_TOLERANCE_M
        ),
        "shared": partial(_core.share_stiffness, tolerance=_TOLERANCE_M),
    }
    return tuple(_measure(name, call, sets, repeats) for name, call in cluster.items())


def _touch(across: int, plate: Decomposition) -> _core.ContactSet:
    """Returns the contacts of a square brush with `across` teeth along a side."""
    brush = make_brush(across**2, across, _WIDTH_M / across)
    return SceneTracker(brush, [plate], _TOLERANCE_M).query(plan_slide(2)[0])


def _measure(
    method: str,
    cluster: Callable[[_core.ContactSet], _core.ClusterSet],
    sets: list[_core.ContactSet],
    repeats: int,
) -> ForceScaling:
    zero, one = np.zeros((1, 3)), np.ones(1)
    forces, median_us = [], []
    for contacts in sets:
        seconds = []
        for _ in range(repeats):
            start = time.perf_counter()
            clusters = cluster(contacts)
            _core.penalty_force(
                clusters, zero[0], np.zeros(6), zero, np.zeros((1, 6)), one, one
            )
            seconds.append(time.perf_counter() - start)
        forces.append(len(clusters))
        median_us.append(1e6 * float(np.median(seconds)))
    numbers = tuple(map(len, sets))
    many = np.array(numbers) >= FEWEST_FITTED
    return ForceScaling(
        method=method,
        contacts=numbers,
        forces=tuple(forces),
        median_us=tuple(median_us),
        force_growth=fit_power(np.array(numbers), np.array(forces)),
        time_growth=fit_power(np.array(numbers)[many], np.array(median_us)[many]),
    )
