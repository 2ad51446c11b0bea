"""How the force computation grows with the contacts (section 6.3)."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from drake_haptics import _core
from drake_haptics._core import SceneTracker
from drake_haptics.evaluation.paper.fits import PowerFit, fit_power
from drake_haptics.evaluation.paper.pair_scaling import (
    grid_of,
    make_plate,
    place_teeth,
    plan_slide,
)
from drake_haptics.evaluation.shapes.surface import SurfaceBuilder
from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
from drake_haptics.geometry.mesh.mesh import Mesh

_TEETH_ACROSS = (1, 2, 4, 6, 8, 12, 16)
_WIDTH_M = 0.04
_CLUSTER_M = 8e-3
# With fewer contacts a call takes most of the time.
FEWEST_FITTED = 16
_TOLERANCE_M = 1e-3


@dataclass(frozen=True)
class ForceScaling:
    """What one way of clustering makes of many contacts.

    Attributes:
        method: "octree" (the paper's) or "shared".
        contacts: Before clustering.
        forces: That are computed: one for each cluster.
        median_us: Of clustering and force, µs.
        force_growth: Of the forces with the contacts.
        time_growth: Of the time with the contacts, from `FEWEST_FITTED` on.
    """

    method: str
    contacts: tuple[int, ...]
    forces: tuple[int, ...]
    median_us: tuple[float, ...]
    force_growth: PowerFit
    time_growth: PowerFit

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures ready for JSON."""
        return asdict(self)


def measure_force_scaling(repeats: int) -> tuple[ForceScaling, ...]:
    """Presses brushes of 1 to 256 teeth, all 40 mm wide, into a plate.

    Args:
        repeats: Of each computation.

    Returns:
        Figures of the paper's clusters (of 8 mm), and of shared stiffness.
    """
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
    """Returns the contacts of a square brush with that many teeth along a side."""
    builder = SurfaceBuilder()
    spacing_m = _WIDTH_M / across
    places = grid_of(across**2, across, spacing_m)
    place_teeth(builder, places, min(spacing_m / 3, 0.002))
    surface = builder.build()
    brush = decompose(Mesh.from_arrays(surface.vertices, surface.triangles))
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
