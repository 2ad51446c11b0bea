"""Runs the part of a tick that is inside the core, and counts its instructions.

`python -m drake_haptics.evaluation.accuracy.native_part FILE` is the program that is
counted; it moves the tool along the motion in FILE.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

import numpy as np

from drake_haptics import _core
from drake_haptics.evaluation.measuring.valgrind import (
    count_with_data,
    counted,
    read_data,
)
from drake_haptics.geometry.decomposition.decompose import Decomposition

_REST = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
# Distance at which nothing touches the tool, m.
_FAR_M = 1e3


@dataclass(frozen=True, eq=False)
class NativePart:
    """The calls to the core in each tick, without Drake; they can be pickled.

    Attributes:
        tool: Pieces of the tool.
        objects: Pieces of each of m objects.
        X_WO: (m, 7) poses [qw qx qy qz x y z] of the objects, m.
        search_m: Distance up to which contacts are found, m.
        depth: See `SceneTracker`, as `max_walk_steps`.
        query_every: Ticks from one contact query to the next, between which contacts
            are extrapolated; None if every tick has a query.
        tolerance_m: Distance up to which contacts push, m.
        cluster_size_m: δ of the octree, m; None if contacts share stiffness.
        stiffness_N_per_m: (m,) of each object, N/m.
        damping_Ns_per_m: (m,) of each object, N·s/m.
    """

    tool: Decomposition
    objects: tuple[Decomposition, ...]
    X_WO: np.ndarray
    search_m: float
    depth: Literal["tracked", "global"]
    max_walk_steps: int
    query_every: int | None
    tolerance_m: float
    cluster_size_m: float | None
    stiffness_N_per_m: np.ndarray
    damping_Ns_per_m: np.ndarray

    def make_clustering(self) -> Callable[[_core.ContactSet], _core.ClusterSet]:
        """Returns a function that makes clusters of contacts."""
        cluster: Callable[..., Any] = _core.share_stiffness
        if self.cluster_size_m is not None:
            cluster = partial(_core.cluster_contacts, delta=self.cluster_size_m)
        return partial(cluster, tolerance=self.tolerance_m)

    def make_force(self) -> Callable[..., _core.PenaltyWrench]:
        """Returns the function of clusters, tool position and velocity to a wrench."""
        return partial(
            _core.penalty_force,
            p_WO=self.X_WO[:, 4:].copy(),
            V_WO=np.zeros((len(self.X_WO), 6)),
            stiffness=self.stiffness_N_per_m,
            damping=self.damping_Ns_per_m,
        )


class ContactSearch:
    """Searches for contacts tick by tick, like the systems of a loop."""

    def __init__(self, part: NativePart):
        """Begins before the first tick."""
        self._every = part.query_every
        self._tracker = _core.SceneTracker(
            part.tool, part.objects, part.search_m, part.depth, part.max_walk_steps
        )
        for i, X_WO in enumerate(part.X_WO):
            self._tracker.set_object_pose(i, X_WO)
        self._carrier = _core.ContactExtrapolation(
            part.tool.core, [item.core for item in part.objects], list(part.X_WO)
        )
        self._tick = 0
        self._sample = self._found_at = _REST
        self._found: _core.ContactSet | None = None

    def look(self, X_WT: np.ndarray) -> tuple[_core.ContactSet, float]:
        """Searches for contacts at a pose (7,) of the tool, if this tick has a query.

        Returns:
            Contacts of the last query, and the time of this tick's query in the core,
            s.
        """
        if self._every is None:
            found = self._tracker.query(X_WT)
            return found, found.query_seconds
        tick, query_s = self._tick, 0.0
        self._tick += 1
        if tick == 0:
            self._sample = X_WT
        # Contacts of a pose that is sampled at a tick are available at the next one.
        if self._found is None or (tick - 1) % self._every == 0:
            self._found_at = self._sample
            self._found = self._tracker.query(self._found_at)
            query_s = self._found.query_seconds
        if tick % self._every == 0:
            self._sample = X_WT
        return self._found, query_s

    def carry(self, found: _core.ContactSet, X_WT: np.ndarray) -> _core.ContactSet:
        """Returns found contacts, extrapolated to the tool's pose."""
        if self._every is None:
            return found
        return self._carrier.advance(found, self._found_at, X_WT)


def count_native(part: NativePart, X_WT: np.ndarray, V_WT: np.ndarray) -> float:
    """Returns the mean instructions of query, clusters and wrench in a tick.

    The tool has n poses (n, 7) and velocities (n, 6). The count of the same calls far
    from all objects is subtracted: that of Python, the binding and the start of the
    program. The first tick, which finds the first contacts, is included. Raises the
    errors of `count_instructions`.
    """
    far = X_WT + _FAR_M * np.eye(7)[4]
    near, base = (count_with_data(__name__, (part, X, V_WT)) for X in (X_WT, far))
    return (near - base) / len(X_WT)


def main() -> None:
    """Moves the tool along the motion in a file, counting."""
    part, X_WT, V_WT = read_data()
    search, cluster = ContactSearch(part), part.make_clustering()
    force = part.make_force()
    with counted():
        for X, V in zip(X_WT, V_WT, strict=True):
            found, _ = search.look(X)
            force(cluster(search.carry(found, X)), X[4:], V)


if __name__ == "__main__":
    main()
