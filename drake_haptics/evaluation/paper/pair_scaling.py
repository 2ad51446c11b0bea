"""How the contact query grows with the pairs that penetrate (section 6.3)."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from drake_haptics._core import SceneTracker
from drake_haptics.evaluation.measuring.timing import typical
from drake_haptics.evaluation.paper.fits import LineFit, fit_line
from drake_haptics.evaluation.shapes.surface import SurfaceBuilder, circle, loft
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.mesh.mesh import Mesh

NUM_TEETH = (1, 2, 4, 8, 16, 32, 64)
_TOLERANCE_M = 1e-3
_DEEP_M = 5e-4
_SPACING_M = 0.005
_ACROSS = 8
_REPEATS = 7


@dataclass(frozen=True)
class PairScaling:
    """Times of a query over the number of pairs that penetrate.

    Attributes:
        pairs: How many penetrate.
        median_us: Of the whole query, µs.
        line: Through them.
    """

    pairs: tuple[int, ...]
    median_us: tuple[float, ...]
    line: LineFit

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures ready for JSON."""
        return asdict(self)


def measure_pair_scaling(ticks: int) -> PairScaling:
    """Slides brushes of 1 to 64 teeth over a plate, all teeth 0.5 mm deep.

    Args:
        ticks: Of each motion.
    """
    plate = make_plate()
    motion = plan_slide(ticks)
    brushes = [make_brush(teeth) for teeth in NUM_TEETH]
    trackers = [SceneTracker(brush, [plate], _TOLERANCE_M) for brush in brushes]
    # In turns, so that what disturbs the computer disturbs all.
    seconds = np.array(
        [
            [_time_slide(tracker, motion) for tracker in trackers]
            for _ in range(_REPEATS)
        ]
    )
    median_us = (1e6 * np.median(typical(seconds), axis=1)).tolist()
    line = fit_line(np.array(NUM_TEETH), median_us)
    return PairScaling(NUM_TEETH, tuple(median_us), line)


def _time_slide(tracker: SceneTracker, motion: np.ndarray) -> list[float]:
    """Returns the time of each query, s."""
    return [tracker.query(X_WT).query_seconds for X_WT in motion]


def make_brush(teeth: int, spacing_m: float = _SPACING_M) -> Decomposition:
    """Returns a tool of separate pointed teeth, their points at z = 0.

    Args:
        teeth: How many, row by row, eight in a row.
        spacing_m: Of the teeth, m; they are a third of it wide.
    """
    builder = SurfaceBuilder()
    place_teeth(builder, grid_of(teeth, _ACROSS, spacing_m), spacing_m / 3)
    surface = builder.build()
    return decompose(Mesh.from_arrays(surface.vertices, surface.triangles))


def grid_of(count: int, across: int, spacing_m: float) -> np.ndarray:
    """Returns (count, 2) places row by row, about the origin, m."""
    row, column = np.divmod(np.arange(count), across)
    return (np.column_stack([column, row]) - (across - 1) / 2) * spacing_m


def place_teeth(builder: SurfaceBuilder, places: np.ndarray, width_m: float) -> None:
    """Adds a tooth at each place (n, 2): eight-sided, convex, 10 mm high, pointed."""
    for x, y in places:
        rings = [
            builder.add_ring(np.add(circle(width_m / 2, z, 8), (x, y, 0.0)))
            for z in (0.003, 0.010)
        ]
        builder.add_fan(rings[0], builder.add_vertex((x, y, 0.0)), at_start=True)
        builder.add_band(*rings)
        builder.add_fan(rings[1], builder.add_vertex((x, y, 0.0105)), at_start=False)


def make_plate(width_m: float = 0.2) -> Decomposition:
    """Returns a plate with its top at z = 0, 20 mm thick."""
    corners = np.array([(1, -1), (1, 1), (-1, 1), (-1, -1)]) * width_m / 2
    levels = [np.column_stack([corners, np.full(4, z)]) for z in (-0.02, 0.0)]
    surface = loft((0.0, 0.0, -0.02), levels, (0.0, 0.0, 0.0))
    return decompose(Mesh.from_arrays(surface.vertices, surface.triangles))


def plan_slide(ticks: int) -> np.ndarray:
    """Returns X_WTool (ticks, 4, 4): round in a circle of 10 mm, 0.5 mm deep."""
    angle = np.linspace(0.0, 2.0 * np.pi, ticks)
    X_WT = np.tile(np.eye(4), (ticks, 1, 1))
    X_WT[:, 0, 3], X_WT[:, 1, 3] = 0.01 * np.cos(angle), 0.01 * np.sin(angle)
    X_WT[:, 2, 3] = -_DEEP_M
    return X_WT
