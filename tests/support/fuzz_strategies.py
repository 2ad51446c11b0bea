"""Hypothesis strategies: shapes and poses that break geometry code, and bad input."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

_UNIT = st.floats(-1, 1, width=32)


def _rows(elements: st.SearchStrategy[Any], most: int) -> st.SearchStrategy[np.ndarray]:
    shapes = st.tuples(st.integers(1, most), st.just(3))
    return shapes.flatmap(lambda s: hnp.arrays(np.float64, s, elements=elements))


@st.composite
def point_sets(draw: Callable[..., Any]) -> np.ndarray:
    """(n, 3) points, m: lattices, flat, straight, doubled, needles, any scale."""
    any_points, lattice = _rows(_UNIT, 20), _rows(st.integers(-2, 2), 20)
    points = draw(st.one_of(any_points, lattice))
    kind = draw(st.sampled_from(["as is", "flat", "straight", "doubled", "needle"]))
    if kind in ("flat", "straight"):
        points = points * ([1, 1, 0] if kind == "flat" else [1, 0, 0])
    elif kind == "doubled":
        noise = 10.0 ** draw(st.integers(-18, -3))
        points = np.concatenate([points, points + noise * points[::-1]])
    elif kind == "needle":
        points = points * [1, 10.0 ** -draw(st.integers(0, 8)), 1e-3]
    if draw(st.booleans()):
        points = points + 10.0 ** draw(st.integers(-3, 6))
    return np.asarray(points * 10.0 ** draw(st.integers(-6, 6)), dtype=float)


@st.composite
def poses(draw: Callable[..., Any]) -> np.ndarray:
    """(4, 4) rigid: any, by quarter turns, or next to one; near and far."""
    X = np.eye(4)
    turn = np.array(draw(st.tuples(_UNIT, _UNIT, _UNIT)))
    quarter = np.array(draw(st.tuples(*[st.integers(0, 3)] * 3))) * np.pi / 2
    small = 10.0 ** draw(st.integers(-16, 0))
    rotation = Rotation.from_rotvec(small * turn) * Rotation.from_euler("xyz", quarter)
    X[:3, :3] = rotation.as_matrix()
    X[:3, 3] = draw(st.tuples(_UNIT, _UNIT, _UNIT))
    X[:3, 3] *= 10.0 ** draw(st.integers(-9, 6))
    return X


def wrong_points() -> st.SearchStrategy[object]:
    """Values that are not an (n, 3) array of finite numbers with one row or more."""
    bad_value = st.sampled_from([np.nan, np.inf, -np.inf, 1e200])
    with_bad_value = bad_value.map(lambda v: np.array([[0, 0, 0], [1, v, 2]]))
    return st.one_of(_wrong_arrays(), with_bad_value, st.just(np.zeros((0, 3))))


def wrong_poses() -> st.SearchStrategy[object]:
    """Values that are not a (4, 4) rigid pose."""

    def with_entry(entry: tuple[int, float]) -> np.ndarray:
        X = np.eye(4)
        X.flat[entry[0]] = entry[1]
        return X

    bad = st.sampled_from([np.nan, np.inf, -np.inf, 2.0, 1e300])
    entries = st.tuples(st.sampled_from([0, 1, 5, 6, 10, 12, 15]), bad)
    return st.one_of(
        _wrong_arrays(),
        entries.map(with_entry),
        st.sampled_from([np.zeros((4, 4)), np.diag([1.0, 1, -1, 1]), np.eye(3)]),
    )


def _wrong_arrays() -> st.SearchStrategy[object]:
    """Wrong shapes and types of every kind."""
    shapes = hnp.array_shapes(min_dims=0, max_dims=4, max_side=5).filter(
        lambda s: s != (4, 4) and not (len(s) == 2 and s[1] == 3)
    )
    return st.one_of(
        st.none(),
        st.text(max_size=4),
        st.floats(),
        st.integers(),
        st.sampled_from(
            [[], [[]], [[1, 2, 3], [1]], [[None] * 3], [["a", "b", "c"]], {}, object()]
        ),
        hnp.arrays(np.float64, shapes),
        hnp.arrays(np.complex128, (3, 3), elements=st.just(1j)),
        st.just(np.array([["x"] * 3] * 3)),
        st.just(np.array([[object()] * 3])),
        st.just(np.zeros((1 << 20, 2), dtype=bool)),
    )
