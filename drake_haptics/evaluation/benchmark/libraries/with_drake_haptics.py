"""Queries convex pairs in this package."""

from __future__ import annotations

from functools import partial
from importlib.metadata import version
from typing import Literal, get_args

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_library import PairAnswers, PairLibrary
from drake_haptics.evaluation.benchmark.pairs import PairShape
from drake_haptics.evaluation.measuring.timing import clock_interval

Depth = Literal["tracked", "global"]


class DrakeHapticsQuery:
    """One pair, timed inside the core, from poses to the contact in the world."""

    def __init__(self, pair: PairShape, depth: Depth):
        A, B = ConvexPolytope(pair.A_vertices), ConvexPolytope(pair.B_vertices)
        self._pair = ConvexPair(A, B, depth=depth)

    def run(self, X_WA: np.ndarray) -> PairAnswers:
        """See `PairQuery.run`."""
        self._pair.reset()
        answers = self._pair.query_trajectory(X_WA, np.eye(4))
        return PairAnswers(
            distance=answers.distance,
            nhat_BA_W=answers.nhat_BA_W,
            seconds=answers.seconds - clock_interval(),
        )


LIBRARIES = [
    PairLibrary(
        name=f"drake_haptics, {depth}",
        version=version("drake_haptics"),
        ours=True,
        make_query=partial(DrakeHapticsQuery, depth=depth),
    )
    for depth in get_args(Depth)
]
