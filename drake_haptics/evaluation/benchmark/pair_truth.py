"""The exact answer of a convex pair, to judge libraries by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drake_haptics.evaluation.benchmark.pair_library import PairAnswers
from drake_haptics.evaluation.benchmark.pair_shapes import PairShape


@dataclass(frozen=True)
class PairTruth:
    """The best answer known of each frame.

    Attributes:
        distance: (n,) signed distances, m.
        nhat_BA_W: (n, 3) unit normals that have them.
    """

    distance: np.ndarray
    nhat_BA_W: np.ndarray


def find_truth(
    pair: PairShape, X_WA: np.ndarray, answers: Sequence[PairAnswers]
) -> PairTruth:
    """Returns the best of all libraries' answers, checked without any of them.

    Every unit vector n bounds the signed distance of two convex bodies from below by
    its support gap h(n) = min n·a − max n·b, and the largest gap is the distance,
    apart as well as in depth. So gaps of the libraries' normals, found by going
    through all vertices, judge all libraries alike: whoever finds a larger one shows
    the others wrong.

    Args:
        pair: the bodies.
        X_WA: (n, 4, 4) poses of A; B is at the world's origin.
        answers: one per library.
    """
    normals = np.stack([a.nhat_BA_W for a in answers])
    gaps = np.stack([support_gaps(pair, X_WA, n) for n in normals])
    gaps[np.isnan(gaps)] = -np.inf
    best = gaps.argmax(axis=0)
    frame = np.arange(len(X_WA))
    return PairTruth(gaps[best, frame], normals[best, frame])


def support_gaps(
    pair: PairShape, X_WA: np.ndarray, nhat_BA_W: np.ndarray
) -> np.ndarray:
    """Returns (n,) support gaps h(n), m, of (n, 3) unit normals from B into A."""
    n_A = np.einsum("fij,fi->fj", X_WA[:, :3, :3], nhat_BA_W)
    offset = np.einsum("fi,fi->f", X_WA[:, :3, 3], nhat_BA_W)
    nearest_A = (n_A @ pair.A_vertices.T).min(axis=1) + offset
    return nearest_A - (nhat_BA_W @ pair.B_vertices.T).max(axis=1)
