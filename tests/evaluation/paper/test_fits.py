"""Fits find the line and the power that data were made of."""

import numpy as np
import pytest

from drake_haptics.evaluation.paper.fits import fit_line, fit_power


def test_a_line_is_found():
    x = np.array([1.0, 2.0, 4.0, 8.0])
    line = fit_line(x, 3.0 - 0.5 * x)
    assert (line.slope, line.intercept) == (pytest.approx(-0.5), pytest.approx(3.0))
    assert line.r_squared == pytest.approx(1.0)


def test_r_squared_is_the_square_of_the_correlation():
    rng = np.random.default_rng(2)
    x = rng.random(50)
    y = 2.0 * x + rng.normal(size=50)
    assert fit_line(x, y).r_squared == pytest.approx(np.corrcoef(x, y)[0, 1] ** 2)


def test_a_constant_is_explained():
    line = fit_line(np.arange(4), np.full(4, 7.0))
    assert line.slope == pytest.approx(0.0, abs=1e-12)
    assert line.r_squared == 1.0


def test_a_power_is_found():
    x = np.array([1.0, 10.0, 100.0, 3000.0])
    power = fit_power(x, 0.2 * x**0.4)
    assert power.exponent == pytest.approx(0.4)
    assert power.factor == pytest.approx(0.2)
    assert power.r_squared == pytest.approx(1.0)


def test_what_cannot_be_fitted_is_said():
    with pytest.raises(ValueError, match="two different"):
        fit_line(np.ones(3), np.arange(3))
    with pytest.raises(ValueError, match="positive"):
        fit_power(np.array([1.0, 2.0]), np.array([0.0, 1.0]))
