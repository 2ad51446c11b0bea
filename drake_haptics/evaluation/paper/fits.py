"""Fits straight lines and powers to measured points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class LineFit:
    """y = intercept + slope x, by least squares.

    R² is the share of y's variance that the line explains.
    """

    slope: float
    intercept: float
    r_squared: float


@dataclass(frozen=True)
class PowerFit:
    """y = factor x ** exponent, by a least-squares line of the logarithms."""

    exponent: float
    factor: float
    r_squared: float


def fit_line(x: np.ndarray, y: np.ndarray) -> LineFit:
    """Fits a line to two or more points.

    Raises:
        ValueError: There are fewer than two distinct x.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(np.unique(x)) < 2:
        raise ValueError(f"x must have two different values or more, is {x}")
    # Imported here, because under valgrind it takes seconds.
    from scipy.stats import linregress

    found = linregress(x, y)
    # A constant y has no correlation, and is fully explained.
    r_squared = 1.0 if np.ptp(y) == 0.0 else found.rvalue**2
    return LineFit(float(found.slope), float(found.intercept), float(r_squared))


def fit_power(x: np.ndarray, y: np.ndarray) -> PowerFit:
    """Fits a power to two or more points.

    Raises:
        ValueError: A value is not positive, or there are fewer than two distinct x.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if not ((x > 0.0).all() and (y > 0.0).all()):
        raise ValueError(f"x and y must be positive, are {x} and {y}")
    line = fit_line(np.log(x), np.log(y))
    return PowerFit(line.slope, float(np.exp(line.intercept)), line.r_squared)
