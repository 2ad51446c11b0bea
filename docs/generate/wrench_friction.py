"""Friction of one contact that is drawn along: the cone, and from stick to slip.

As in wrench_scenarios.py; N is the normal force, μ the coefficient of sliding, r the
static one over it, b how far a contact gives way before it slips.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from contact_samples import spike
from scipy.spatial.transform import Rotation
from wrench_chain import X_WS, Case, place, run_chain, turned, wrench_at
from wrench_scenarios import OFFSET, K, T, X, Y, Z, make_floor

from drake_haptics import _core

MU, R, B_M = 0.4, 1.25, 1e-4
_D = -3e-4
N = K * (T - _D)
_REACH_M = 5e-3
_ARM_M = 0.01


def _draw(method: str, path: Iterable[np.ndarray]) -> np.ndarray:
    """Returns friction alone on a tip at each point it is drawn to, (n, 6) in S."""
    model = _core.StickSlipModel([MU], [False], R, B_M, _REACH_M)
    state = np.zeros(model.state_size)
    shape, floor = spike(-OFFSET), make_floor()
    felt = []
    for p in path:
        tool = place(shape, p + _D * Z + OFFSET)
        found = run_chain(tool, [floor], method)
        step = model.step(
            state, found.clusters, found.answer, _vector(X_WS @ tool.X_SB), np.empty(0)
        )
        state = step.next_state
        felt.append(turned(X_WS[:3, :3].T, step.wrench_model[:6]))
    return np.array(felt)


def _vector(X: np.ndarray) -> np.ndarray:
    """Returns [qw qx qy qz x y z] of a (4, 4) pose."""
    x, y, z, w = Rotation.from_matrix(X[:3, :3]).as_quat()
    return np.array([w, x, y, z, *X[:3, 3]])


def _pull(f: np.ndarray) -> np.ndarray:
    """Returns a friction force as a wrench: at p̂, halfway between tip and floor."""
    return wrench_at(-_D / 2 * Z - OFFSET, f)


def stick_to_slip(method: str) -> Iterator[Case]:
    """A tip drawn along in steps sticks, gives way, slides, and sticks again."""
    steps = np.arange(0, 301) * B_M / 100
    felt = _draw(method, steps[:, None] * X)
    weak = B_M * (1 + 1 / R)
    falling = R - (R - 1) * R * (steps - B_M) / B_M
    force = np.where(
        steps <= B_M, R * steps / B_M, np.where(steps < weak, falling, 1.0)
    )
    for name, formula, of in (
        ("a tip drawn along, it sticks", "f = −r μ N x / b", steps <= B_M),
        (
            "a tip drawn along, it gives way",
            "f = −(r − (r − 1) r (x − b) / b) μ N",
            (steps > B_M) & (steps < weak),
        ),
        ("a tip drawn along, it slides", "f = −μ N", steps > weak),
    ):
        yield Case(
            name,
            formula,
            "4.4.2",
            method,
            np.array([_pull(-MU * N * x * X) for x in force[of]]),
            felt[of],
            _ARM_M,
        )
    back = np.arange(0, 101) * B_M / 100
    path = np.concatenate([steps, steps[-1] - back])
    yield Case(
        "a tip that slid, drawn back",
        "f = −μ N + r μ N y / b",
        "4.4.2",
        method,
        np.array([_pull(MU * N * (R * y / B_M - 1) * X) for y in back]),
        _draw(method, path[:, None] * X)[len(steps) :],
        _ARM_M,
    )


def friction_cone(method: str) -> Iterator[Case]:
    """A tip slid far in twelve directions: the whole force lies on the cone."""
    expected, measured = [], []
    for angle in np.linspace(0, 2 * np.pi, 12, endpoint=False):
        u = np.cos(angle) * X + np.sin(angle) * Y
        path = np.arange(0, 51)[:, None] * B_M / 10 * u
        expected.append(_pull(-MU * N * u))
        measured.append(_draw(method, path)[-1])
    yield Case(
        "a tip slid in twelve directions",
        "f = −μ N u, on the cone of angle arctan μ",
        "4.4.2",
        method,
        np.array(expected),
        np.array(measured),
        _ARM_M,
    )
