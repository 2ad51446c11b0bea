"""Times one pair query from Python, in this package and in coal's binding."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.outside_library import OutsideLibrary
from drake_haptics.evaluation.benchmark.pairs import PairShape, make_presses
from drake_haptics.evaluation.measuring.timing import typical


@dataclass(frozen=True)
class PythonFigures:
    """Median times of one query from a Python program, from the pose to the distance.

    They are those of this package (tracked), of coal's fastest start, and of outside
    libraries.
    """

    kind: str
    size: int
    ours_us: float
    coal_us: float
    outside_us: dict[str, float] = field(default_factory=dict)

    @property
    def ratio(self) -> float:
        """Ratio of this package's time to coal's."""
        return self.ours_us / self.coal_us


def run_python_pair(
    pair: PairShape, repeats: int, outside: Sequence[type[OutsideLibrary]] = ()
) -> PythonFigures:
    """Returns the times of a single query from Python, on all frames of a press.

    All take a (4, 4) pose and return the distance, in turns. Coal needs a pose object,
    which is part of its query.
    """
    bodies = pair.A_vertices, pair.B_vertices
    ours = ConvexPair(ConvexPolytope(bodies[0]), ConvexPolytope(bodies[1]))
    X_WB = np.eye(4)
    queries: dict[str, Callable[[np.ndarray], object]] = {
        "ours": lambda X_WA: ours.query(X_WA, X_WB).distance,
        "cold": CoalQuery(*bodies, "DefaultGuess"),
        "boxes": CoalQuery(*bodies, "BoundingVolumeGuess"),
        "warm": CoalQuery(*bodies, "CachedGuess"),
    }
    for library in outside:
        queries[library.name] = library(*bodies).query
    (X_WA,) = make_presses(pair, 1)
    seconds = [[_timed(q, X_WA) for q in queries.values()] for _ in range(repeats)]
    medians_us = 1e6 * np.median(typical(np.array(seconds)), axis=1)
    medians = dict(zip(queries, medians_us.tolist(), strict=True))
    ours_us = medians.pop("ours")
    outside_us = {library.name: medians.pop(library.name) for library in outside}
    coal_us = min(medians.values())
    return PythonFigures(pair.kind, pair.size, ours_us, coal_us, outside_us)


def _timed(query: Callable[[np.ndarray], object], X_WA: np.ndarray) -> list[float]:
    seconds = []
    for X in X_WA:
        start = time.perf_counter()
        query(X)
        seconds.append(time.perf_counter() - start)
    return seconds


class CoalQuery:
    """A pair of hulls in coal's binding, queried at successive poses.

    Attributes:
        result: The result of coal's last query.
    """

    def __init__(self, A_vertices: np.ndarray, B_vertices: np.ndarray, start: str):
        """Builds the hulls of the moving and the resting body's vertices.

        The start of GJK is a name of `coal.GJKInitialGuess`.

        Raises:
            ImportError: coal is not installed.
        """
        import coal

        def make_hull(vertices: np.ndarray) -> coal.Convex:
            points = coal.StdVec_Vec3s()
            points.extend(list(vertices))
            hull = coal.Convex.convexHull(points, True, "Qt")
            hull.computeLocalAABB()
            return hull

        # `ComputeDistance` does not keep the bodies alive.
        self._bodies = make_hull(A_vertices), make_hull(B_vertices)
        self._compute = coal.ComputeDistance(*self._bodies)
        self._request = coal.DistanceRequest()
        self._request.enable_signed_distance = True
        self._request.gjk_initial_guess = getattr(coal.GJKInitialGuess, start)
        self.result = coal.DistanceResult()
        self._make_pose, self._X_WB = coal.Transform3s, coal.Transform3s()

    def __call__(self, X_WA: np.ndarray) -> float:
        """Returns the signed distance, m, at a pose (4, 4) of A; B is at the origin."""
        X = self._make_pose(X_WA[:3, :3], X_WA[:3, 3])
        self.result.clear()
        distance: float = self._compute(X, self._X_WB, self._request, self.result)
        self._request.updateGuess(self.result)
        return distance
