"""Hold derivatives of the core and of systems against central differences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from drake_haptics._core import AutoDiffVector


def seeded(value: object, first: int = 0, count: int | None = None) -> AutoDiffVector:
    """Variables: entry i is variable `first` + i of `count`."""
    value = np.asarray(value, dtype=float).ravel()
    count = first + len(value) if count is None else count
    gradient = np.zeros((len(value), count))
    gradient[:, first : first + len(value)] = np.eye(len(value))
    return AutoDiffVector(value, gradient)


def constant(value: object, count: int) -> AutoDiffVector:
    """What no variable changes."""
    value = np.asarray(value, dtype=float).ravel()
    return AutoDiffVector(value, np.zeros((len(value), count)))


def central_differences(
    function: Callable[[np.ndarray], np.ndarray], x: np.ndarray, step: float
) -> np.ndarray:
    """The derivative (n, D) of a function of doubles."""
    return np.column_stack(
        [
            (np.ravel(function(x + e)) - np.ravel(function(x - e))) / (2 * step)
            for e in step * np.eye(len(x))
        ]
    )


def relative_error(found: np.ndarray, expected: np.ndarray) -> float:
    """Largest difference over the largest entry expected."""
    largest = np.abs(expected).max(initial=0.0)
    difference = np.abs(found - expected).max(initial=0.0)
    return float(difference / largest) if largest > 0 else float(difference)


def check_derivatives(
    function: Callable[[np.ndarray], np.ndarray],
    answer: AutoDiffVector,
    x: np.ndarray,
    *,
    step: float = 1e-6,
    tolerance: float = 1e-6,
) -> None:
    """Asserts that an answer is the function's value with all of its derivatives.

    Args:
        function: Of doubles, of the variables.
        answer: What the AutoDiff version gives, by the same variables.
        x: (D,) the variables' values.
        step: Of the differences.
        tolerance: Of the derivative, relative to its largest entry.
    """
    x = np.asarray(x, dtype=float)
    value = np.ravel(function(x))
    assert answer.gradient.shape == (len(value), len(x))
    np.testing.assert_allclose(answer.value, value, rtol=1e-12, atol=1e-14)
    expected = central_differences(function, x, step)
    error = relative_error(answer.gradient, expected)
    assert error < tolerance, f"derivatives are wrong by {error:.1e} of the largest"
