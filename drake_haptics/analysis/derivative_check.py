"""Finds derivatives that a system dropped on the way, by differences in doubles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drake_haptics.analysis.sampled_map import SampledMap, SampledValues

# Steps relative to a coordinate's size: the large ones for noisy functions, the small
# ones for curved ones. The best counts.
_STEPS = (1e-4, 1e-5, 1e-6, 1e-7)
# Lost derivatives disagree by their own size; smooth functions agree to 1e-6.
_TOLERANCE = 1e-4
# Differences of values cannot be finer than this.
_ROUND_OFF = 16.0 * np.finfo(float).eps


def check_derivatives(
    one_period: SampledMap,
    jacobian: SampledValues,
    x: np.ndarray,
    held: np.ndarray,
    u: np.ndarray,
    row_names: Sequence[str],
    column_names: Sequence[str],
) -> None:
    """Compares a Jacobian with central differences along one random direction.

    A Python system that calculates in doubles under AutoDiffXd loses derivatives
    without a word; this finds each row where that is more than 1e-4 of the row.

    Args:
        one_period: The functions.
        jacobian: Their derivatives, from `SampledMap.differentiate` at the same point.
        x: (n,) state.
        held: (n,) state after the update.
        u: (m,) input.
        row_names: Of update, rates and output.
        column_names: Of x and u.

    Raises:
        ValueError: They disagree; names rows and columns.
    """
    rng = np.random.default_rng(20)
    sizes = np.maximum(np.abs(np.concatenate([x, u])), 1.0)
    # No coordinate is left out by a step that happens to be small.
    direction = sizes * rng.uniform(0.5, 1.0, len(sizes))
    direction *= rng.choice([-1.0, 1.0], len(sizes))
    wrong = _find_wrong_rows(one_period, jacobian, x, held, u, direction)
    if not wrong.any():
        return
    axes = np.diag(sizes)
    columns = np.array(
        [
            (wrong & _find_wrong_rows(one_period, jacobian, x, held, u, axis)).any()
            for axis in axes
        ]
    )
    raise ValueError(
        "derivatives are lost, or the system is not smooth here: how"
        f" {_list(row_names, wrong)} changes with {_list(column_names, columns)} is"
        " otherwise in AutoDiffXd than by differences of doubles. A system that takes"
        " values out of AutoDiffXd (ExtractValue, float) must put their gradient back;"
        " at a kink, as where a contact just opens, move the state off it"
    )


def _find_wrong_rows(
    one_period: SampledMap,
    jacobian: SampledValues,
    x: np.ndarray,
    held: np.ndarray,
    u: np.ndarray,
    direction: np.ndarray,
) -> np.ndarray:
    """Returns which rows disagree along a direction at every step size."""
    rows = jacobian.stack()
    predicted, terms = rows @ direction, np.abs(rows) @ np.abs(direction)
    sizes = np.abs(one_period.calc(x, held, u).stack())
    step_x, step_u = direction[: len(x)], direction[len(x) :]
    wrong = np.ones(len(rows), dtype=bool)
    for h in _STEPS:
        ahead, behind = (
            one_period.calc(x + s * step_x, held + s * step_x, u + s * step_u).stack()
            for s in (h, -h)
        )
        difference = (ahead - behind) / (2.0 * h)
        allowed = _TOLERANCE * (terms + np.abs(difference)) + _ROUND_OFF * sizes / h
        wrong &= ~(np.abs(difference - predicted) <= allowed)
    return wrong


def _list(names: Sequence[str], chosen: np.ndarray) -> str:
    found = [name for name, here in zip(names, chosen, strict=True) if here]
    more = f" and {len(found) - 4} more" if len(found) > 4 else ""
    return (", ".join(found[:4]) or "the state as a whole") + more
