"""Checks the values of arguments before they are used."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Numbers = float | Sequence[float] | np.ndarray


def check_positive(**values: Numbers) -> None:
    """Raises ValueError unless all numbers are above 0 and finite.

    Raises TypeError for a value that is not of numbers.
    """
    for name, value in values.items():
        if not np.all((_to_array(name, value) > 0.0) & np.isfinite(value)):
            raise ValueError(f"{name} must be positive and finite, is {value}")


def check_at_least(least: float, **values: Numbers) -> None:
    """Raises ValueError unless all numbers are at least `least` and finite.

    Raises TypeError for a value that is not of numbers.
    """
    for name, value in values.items():
        if not np.all((_to_array(name, value) >= least) & np.isfinite(value)):
            raise ValueError(
                f"{name} must be at least {least:g} and finite, is {value}"
            )


def _to_array(name: str, value: Numbers) -> np.ndarray:
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be a number, is {value!r}")
    return array
