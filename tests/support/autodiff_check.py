"""Hold derivatives of the core and of systems against central differences."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from drake_haptics._core import AutoDiffVector

# Weights of central differences of fourth and of sixth order.
_STENCILS = ({1: 2 / 3, 2: -1 / 12}, {1: 3 / 4, 2: -3 / 20, 3: 1 / 60})
# How far a difference looks, in steps.
REACH = 3


def seeded(value: object) -> AutoDiffVector:
    """Returns variables: each entry is one."""
    value = np.asarray(value, dtype=float).ravel()
    return AutoDiffVector(value, np.eye(len(value)))


def constant(value: object, count: int) -> AutoDiffVector:
    """Returns values that none of `count` variables changes."""
    value = np.asarray(value, dtype=float).ravel()
    return AutoDiffVector(value, np.zeros((len(value), count)))


def flatten(answer: object, names: Iterable[str]) -> np.ndarray:
    """Columns of a set of doubles, one after another."""
    return np.concatenate([np.ravel(getattr(answer, name)) for name in names])


def flatten_gradients(
    answer: object, names: Iterable[str]
) -> tuple[AutoDiffVector, dict[str, slice]]:
    """Columns of a set with derivatives, one after another, and where each is."""
    columns = {name: getattr(answer, name) for name in names}
    ends = np.cumsum([len(column) for column in columns.values()])
    blocks = {
        name: slice(end - len(column), end)
        for (name, column), end in zip(columns.items(), ends, strict=True)
    }
    return (
        AutoDiffVector(
            np.concatenate([column.value for column in columns.values()]),
            np.vstack([column.gradient for column in columns.values()]),
        ),
        blocks,
    )


def derivative_errors(
    function: Callable[[np.ndarray], np.ndarray],
    answer: AutoDiffVector,
    x: np.ndarray,
    step: float,
    blocks: Mapping[str, object],
    tolerance: float = 1e-6,
) -> dict[str, float]:
    """Compares derivatives with central differences of sixth order.

    Args:
        function: Function of doubles, of the variables.
        answer: Answer of the AutoDiff version, by the same variables.
        x: (D,) the variables' values.
        step: Step of the differences.
        blocks: Rows of the answer that are of one kind.
        tolerance: Smallest error that differences must be able to tell.

    Returns:
        The largest error of each block relative to its largest derivative. Blocks are
        left out where differences of fourth and sixth order disagree by a tenth of the
        tolerance: there is a kink, or the function bends too much for them.
    """
    ahead, behind = (
        {
            k: np.array(
                [function(x + sign * k * step * axis) for axis in np.eye(len(x))]
            )
            for k in range(1, REACH + 1)
        }
        for sign in (1, -1)
    )
    fourth, sixth = (
        sum(w * (ahead[k] - behind[k]) for k, w in stencil.items()).T / step
        for stencil in _STENCILS
    )
    assert answer.gradient.shape == sixth.shape
    errors = {}
    for name, rows in blocks.items():
        # What is smaller cannot be told from the rounding of the differences.
        value = np.abs(answer.value[rows]).max(initial=0.0)
        floor = 64 * np.finfo(float).eps * value / (step * tolerance)
        largest = max(np.abs(sixth[rows]).max(initial=0.0), floor, 1e-300)
        if (
            np.abs(fourth[rows] - sixth[rows]).max(initial=0.0)
            < 0.1 * tolerance * largest
        ):
            difference = np.abs(answer.gradient[rows] - sixth[rows]).max(initial=0.0)
            errors[name] = float(difference / largest)
    return errors


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
        function: Function of doubles, of the variables.
        answer: Answer of the AutoDiff version, by the same variables.
        x: (D,) the variables' values.
        step: Step of the differences.
        tolerance: Tolerance of the derivative, relative to its largest entry.
    """

    def flat(x: np.ndarray) -> np.ndarray:
        return np.ravel(function(x))

    np.testing.assert_allclose(answer.value, flat(x), rtol=1e-12, atol=1e-14)
    errors = derivative_errors(flat, answer, x, step, {"all": slice(None)}, tolerance)
    assert errors, "there is a kink, or the step is too long"
    assert errors["all"] < tolerance, f"derivatives are off by {errors['all']:.1e}"
