"""Checks the values of arguments before they are used."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Numbers = float | Sequence[float] | np.ndarray


def check_positive(**values: Numbers) -> None:
    """Raises ValueError unless all numbers are above 0 and finite."""
    for name, value in values.items():
        if not np.all((np.asarray(value) > 0.0) & np.isfinite(value)):
            raise ValueError(f"{name} must be positive and finite, is {value}")


def check_at_least(least: float, **values: Numbers) -> None:
    """Raises ValueError unless all numbers are at least `least` and finite."""
    for name, value in values.items():
        if not np.all((np.asarray(value) >= least) & np.isfinite(value)):
            raise ValueError(
                f"{name} must be at least {least:g} and finite, is {value}"
            )
