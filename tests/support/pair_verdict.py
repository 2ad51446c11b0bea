"""Judges one answer of a pair query against the exact one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from exact_minkowski import ExactPair
from scipy.optimize import nnls

# |error| ≤ SHARE · scale + SHARE · |distance|
SHARE = 1e-9


@dataclass(frozen=True)
class Answer:
    """A library's answer: distance (m), unit normal from B into A, witnesses (m)."""

    distance: float
    nhat_BA_W: np.ndarray
    p_WCa: np.ndarray
    p_WCb: np.ndarray


@dataclass(frozen=True)
class Verdict:
    """The comparison of an answer with the exact one.

    Attributes:
        error: Error of the distance, as a share of scale + |distance|; of a tracked
            depth, against the exact gap along its own normal.
        complaints: Complaints in words; empty if the answer is right.
        is_global: Whether the distance is the exact one.
    """

    error: float
    complaints: tuple[str, ...]
    is_global: bool


def outside(points: np.ndarray, p: np.ndarray) -> float:
    """A bound from above of p's distance to the hull of points (n, 3), m."""
    about = points - p
    size = max(np.abs(about).max(), 1e-300)
    weights, _ = nnls(
        np.vstack([about.T / size, np.ones(len(points))]), np.array([0, 0, 0, 1.0])
    )
    return float(np.linalg.norm(weights / weights.sum() @ about))


def judge(exact: ExactPair, answer: Answer, tracked: bool) -> Verdict:
    """Returns the verdict; a tracked depth need not be the global one."""
    truth, d, n = exact.signed_distance, answer.distance, answer.nhat_BA_W
    numbers = np.concatenate([[d], n, answer.p_WCa, answer.p_WCb])
    if not np.isfinite(numbers).all():
        return Verdict(np.inf, ("not finite",), False)
    size = max(exact.scale + abs(d), np.finfo(float).tiny)  # two points have none
    tolerance = SHARE * size
    found = []
    if abs(np.linalg.norm(n) - 1) > SHARE:
        found.append(f"normal of length {np.linalg.norm(n):.3g}")
    gap = exact.float_gap(n) if np.any(n) else -np.inf
    if abs(gap - d) > tolerance and not (tracked and d > truth):
        found.append(f"the gap along the normal is off {d:.3e} by {gap - d:.1e}")
    is_global = abs(d - truth) <= tolerance
    error = abs(d - truth) / size
    if not is_global:
        if tracked and d < 0 and truth <= 0 and d < truth:
            error = abs(gap - d) / size
            if not exact.is_local_minimum(n, tolerance):
                found.append(f"{d:.9g} is no local minimum; exact {truth:.9g}")
        else:
            found.append(f"{d:.9g} instead of {truth:.9g}")
    # Positions in the world carry the poses' own rounding.
    own = 4 * np.finfo(float).eps * max(map(float, abs(answer.p_WCa)))
    p_a, p_b = (exact.local(p) for p in (answer.p_WCa, answer.p_WCb))
    joined = np.linalg.norm(p_a - p_b - d * n)
    if joined > tolerance + own:
        found.append(f"witnesses differ from distance · normal by {joined:.2e}")
    for name, points, p in (("A", exact.a_float, p_a), ("B", exact.b_float, p_b)):
        away = outside(points, p)
        if away > tolerance + own:
            found.append(f"witness {away:.2e} off {name}")
    return Verdict(float(error), tuple(found), is_global)
