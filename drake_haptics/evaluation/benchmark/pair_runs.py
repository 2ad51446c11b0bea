"""Measures libraries on a convex pair, compared with its exact answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from drake_haptics.evaluation.benchmark.pair_library import PairAnswers, PairLibrary
from drake_haptics.evaluation.benchmark.pairs import PairShape, make_presses
from drake_haptics.evaluation.measuring.timing import TickTimes, run_in_turns

# Least distance of frames with a relative error, m.
_JUDGED_M = 1e-6
# Relative tolerance, above round-off, within which a depth is the global one.
_EXACT = 1e-9
# Relative error beyond which a frame is wrong, more than any tolerance explains.
_WRONG = 1e-3
_STEADY_RAD = np.radians(1.0)


class PairTruth(NamedTuple):
    """The signed distances (n,), m, and the normals with these support gaps."""

    distance: np.ndarray
    nhat_BA_W: np.ndarray


def find_truth(
    pair: PairShape, X_WA: np.ndarray, answers: Sequence[PairAnswers]
) -> PairTruth:
    """Returns the best of all libraries' answers, checked independently.

    Every unit vector n bounds the signed distance of two convex bodies from below by
    its support gap h(n) = min n·a − max n·b, and the largest gap is the distance, apart
    as well as in depth. Therefore the gaps of the libraries' normals, computed over all
    vertices, judge all libraries alike: one that finds a larger gap shows that the
    others are wrong.
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


@dataclass(frozen=True)
class PairFigures:
    """Times and errors of one library on one pair.

    Attributes:
        size: Vertices of each body.
        apart: Times of the frames in which the bodies are apart.
        in_depth: Times of the frames in which they penetrate.
        max_relative_error: Largest relative error of the distance, over the frames of
            at least 1 µm.
        wrong_share: Share of the frames that are wrong by more than 0.1 %.
        exact_depth_share: Share of the frames in depth that have the global depth.
        max_jump_deg: Largest turn of the normal in a frame in which the exact one turns
            by less than 1°.
        failed_frames: Frames without an answer.
    """

    kind: str
    size: int
    library: str
    ours: bool
    apart: TickTimes
    in_depth: TickTimes
    max_relative_error: float
    wrong_share: float
    exact_depth_share: float
    max_jump_deg: float
    failed_frames: int
    outside: bool = False


def run_pair(
    pair: PairShape, libraries: Sequence[PairLibrary], presses: int, repeats: int
) -> list[PairFigures]:
    """Returns the figures of each library on one pair.

    The libraries take turns on each press, in rotating order, in this thread. The first
    frame of a press starts cold and is left out.
    """
    queries = [library.make_query(pair) for library in libraries]
    answers, truths = [], []
    for X_WA in make_presses(pair, presses):
        found = run_in_turns([query.run for query in queries], X_WA, repeats)
        truths.append(find_truth(pair, X_WA, found))
        answers.append(found)
    of_libraries = zip(libraries, zip(*answers, strict=True), strict=True)
    return [_figures(pair, library, own, truths) for library, own in of_libraries]


def _figures(
    pair: PairShape,
    library: PairLibrary,
    answers: Sequence[PairAnswers],
    truths: Sequence[PairTruth],
) -> PairFigures:
    time_s = np.concatenate([a.seconds[1:] for a in answers])
    distance = np.concatenate([a.distance[1:] for a in answers])
    exact = np.concatenate([t.distance[1:] for t in truths])
    jumps = [
        _jumps(a.nhat_BA_W, t.nhat_BA_W) for a, t in zip(answers, truths, strict=True)
    ]
    deep = exact < 0
    judged = (np.abs(exact) >= _JUDGED_M) & np.isfinite(distance)
    error = np.abs(distance - exact)[judged] / np.abs(exact)[judged]
    right = np.abs(distance - exact) <= _EXACT * np.abs(exact) + _EXACT * _JUDGED_M
    return PairFigures(
        kind=pair.kind,
        size=pair.size,
        library=library.name,
        ours=library.ours,
        apart=TickTimes.of(time_s[~deep]),
        in_depth=TickTimes.of(time_s[deep]),
        max_relative_error=float(error.max(initial=0.0)),
        wrong_share=float((error > _WRONG).mean()) if len(error) else 0.0,
        exact_depth_share=float(right[deep].mean()) if deep.any() else 1.0,
        max_jump_deg=float(np.degrees(np.concatenate(jumps).max(initial=0.0))),
        failed_frames=int((~np.isfinite(distance)).sum()),
        outside=library.outside,
    )


def _jumps(normals: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Returns turns (m,) of normals, rad, where the exact ones turn steadily."""
    steady = _turns(exact) < _STEADY_RAD
    turns = _turns(normals)[steady]
    return turns[np.isfinite(turns)]


def _turns(normals: np.ndarray) -> np.ndarray:
    """Returns the angles (n - 1,) between successive (n, 3) unit vectors, rad."""
    before, after = normals[:-1], normals[1:]
    sine = np.linalg.norm(np.cross(before, after), axis=1)
    return np.arctan2(sine, (before * after).sum(axis=1))
