"""Finds derivatives that a system has lost, by differences in doubles."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

# Steps relative to a coordinate's size: large ones for noisy functions, small ones for
# curved ones. The best one counts.
_STEPS = (1e-4, 1e-5, 1e-6, 1e-7)
# Lost derivatives differ by their size; smooth functions agree to 1e-6.
_TOLERANCE = 1e-4
# Distance from the point at which derivatives are checked, relative to a coordinate's
# size; larger than the steps that matter.
_BESIDE = 3e-5
# Differences of values cannot be finer than this.
_ROUND_OFF = 16.0 * np.finfo(float).eps


def check_derivatives(
    function: Callable[[np.ndarray], np.ndarray],
    jacobian: np.ndarray,
    sizes: np.ndarray,
    row_names: Sequence[str],
    column_names: Sequence[str],
) -> None:
    """Compares a Jacobian with central differences along one random direction.

    A Python system that calculates in doubles under AutoDiffXd silently loses
    derivatives; this function finds each row with a relative error above 1e-4.

    Args:
        function: Function of a step (n,) from the point that returns the values (p,).
        jacobian: (p, n) its derivative at the point.
        sizes: (n,) size of a unit step in each coordinate.
        row_names: (p,) names of the values.
        column_names: (n,) names of the coordinates.

    Raises:
        ValueError: They disagree; the message names rows and columns.
    """
    wrong = find_wrong_rows(function, jacobian, sizes)
    if not wrong.any():
        return
    columns = np.array(
        [(wrong & _compare(function, jacobian, axis)).any() for axis in np.diag(sizes)]
    )
    changes = f"{_list(row_names, wrong)} changes with {_list(column_names, columns)}"
    raise ValueError(
        "derivatives are lost, or the system is not smooth here: AutoDiffXd and"
        f" differences of doubles disagree on how {changes}. A system that takes"
        " values out of AutoDiffXd (ExtractValue, float) must put their gradient back;"
        " at a kink, as where a contact just opens, move the state off it"
    )


def find_wrong_rows(
    function: Callable[[np.ndarray], np.ndarray],
    jacobian: np.ndarray,
    sizes: np.ndarray,
) -> np.ndarray:
    """Returns which rows disagree with differences, (p,); arguments as above."""
    rng = np.random.default_rng(20)
    # No step is so small that a coordinate is left out.
    direction = rng.uniform(0.5, 1.0, len(sizes)) * rng.choice([-1.0, 1.0], len(sizes))
    return _compare(function, jacobian, sizes * direction)


def move_beside(point: np.ndarray, side: float = 1.0) -> np.ndarray:
    """Returns a point (n,) near another.

    At an equilibrium bodies are at rest, flush or symmetric, so that it is often at a
    kink, where central differences mix two slopes. Next to it there is only one slope.

    Args:
        point: (n,) point to move away from.
        side: 1, or -1 for the point on the opposite side.
    """
    shift = np.random.default_rng(1).uniform(-1.0, 1.0, len(point))
    return point + side * _BESIDE * calc_sizes(point) * shift


def calc_sizes(x: np.ndarray) -> np.ndarray:
    """Returns the size of each coordinate, at least 1."""
    return np.maximum(np.abs(x), 1.0)


def _compare(
    function: Callable[[np.ndarray], np.ndarray],
    jacobian: np.ndarray,
    direction: np.ndarray,
) -> np.ndarray:
    """Returns which rows disagree along a direction at every step size."""
    predicted = jacobian @ direction
    terms = np.abs(jacobian) @ np.abs(direction)
    magnitudes = np.abs(function(np.zeros_like(direction)))
    wrong = np.ones(len(predicted), dtype=bool)
    for h in _STEPS:
        change = function(h * direction) - function(-h * direction)
        difference = change / (2.0 * h)
        allowed = _TOLERANCE * (terms + np.abs(difference))
        allowed += _ROUND_OFF * magnitudes / h
        wrong &= ~(np.abs(difference - predicted) <= allowed)
    return wrong


def _list(names: Sequence[str], chosen: np.ndarray) -> str:
    found = [name for name, here in zip(names, chosen, strict=True) if here]
    more = f" and {len(found) - 4} more" if len(found) > 4 else ""
    return (", ".join(found[:4]) or "the state as a whole") + more
