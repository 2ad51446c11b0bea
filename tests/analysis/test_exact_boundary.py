"""The exact boundary of a sampled spring and damper, against its polynomial."""

import numpy as np
import pytest
from sampled_loop import SampledLoop

from drake_haptics.analysis.exact_boundary import (
    calc_boundary_peak,
    calc_boundary_point,
    calc_exact_alpha,
    calc_exact_boundary,
)
from drake_haptics.bounds.sampled_spring import calc_sampled_stiffness


def make_loop_polynomial(alpha, beta, delay):
    """Returns z^(d+1) (z - 1)² + (α z + β (z - 1)) (z + 1)/2, highest power first."""
    return SampledLoop(1.0, 1.0, delay=delay).make_polynomial(alpha, beta)


def calc_largest_root(alpha, beta, delay):
    return np.abs(np.roots(make_loop_polynomial(alpha, beta, delay))).max()


@pytest.mark.parametrize("delay", [0, 1, 2, 3, 4, 9])
def test_points_of_the_boundary_are_roots_on_the_unit_circle(delay):
    for share in np.linspace(0.05, 1.0, 20):
        angle = share * np.pi / (2 * (delay + 1))
        point = calc_boundary_point(angle, delay)
        polynomial = make_loop_polynomial(point.alpha, point.beta, delay)
        assert np.polyval(polynomial, np.exp(1j * angle)) == pytest.approx(0, abs=1e-13)


@pytest.mark.parametrize("delay", [0, 1, 2, 3, 4, 9])
def test_below_the_curve_is_stable_and_above_it_is_not(delay):
    end = calc_boundary_point(np.pi / (2 * (delay + 1)), delay).beta
    for beta in np.linspace(0.02, 0.98, 30) * end:
        alpha = calc_exact_alpha(beta, delay)
        # All of what is below, not only its edge.
        for share in (1e-3, 0.1, 0.5, 0.9, 0.999):
            assert calc_largest_root(share * alpha, beta, delay) < 1
        for factor in (1.001, 1.5, 4.0, 30.0):
            assert calc_largest_root(factor * alpha, beta, delay) > 1
    assert calc_exact_alpha(1.001 * end, delay) == 0.0
    assert calc_largest_root(1e-6, 1.001 * end, delay) > 1


def test_without_delay_it_is_jurys():
    for beta in np.linspace(0.0, 2.2, 23):
        jury = calc_sampled_stiffness(1.0, beta, 1.0)
        assert calc_exact_alpha(beta, 0) == pytest.approx(jury, abs=1e-14)


@pytest.mark.parametrize("delay", [0, 1, 2, 3, 4])
def test_the_peak_is_the_highest_point_of_the_curve(delay):
    boundary = calc_exact_boundary(delay, 4001)
    assert boundary.alpha.max() <= boundary.peak.alpha
    assert boundary.alpha.max() == pytest.approx(boundary.peak.alpha, rel=1e-6)
    at = boundary.beta[boundary.alpha.argmax()]
    assert at == pytest.approx(boundary.peak.beta, rel=2e-3)
    assert boundary.alpha[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-15)
    assert calc_boundary_peak(delay) == boundary.peak


def test_the_plot_shows_the_curve_and_its_tangent():
    pytest.importorskip("matplotlib").use("Agg")
    boundary = calc_exact_boundary(1, 50)
    axes = boundary.plot()
    curve, peak, tangent = axes.lines
    assert np.array_equal(curve.get_xdata(), boundary.beta)
    assert np.array_equal(curve.get_ydata(), boundary.alpha)
    assert peak.get_ydata() == [boundary.peak.alpha]
    x, y = tangent.get_data()
    assert y[1] / x[1] == pytest.approx(1 / 1.5)
    # The next one joins it.
    assert calc_exact_boundary(2).plot(axes) is axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "1 period of delay",
        "2 periods of delay",
    ]


def test_it_is_plain_data():
    data = calc_exact_boundary(1, 3).to_dict()
    assert data["beta"][0] == 0.0 and len(data["alpha"]) == 3
    assert data["peak"]["beta"] == pytest.approx(0.42469, abs=1e-5)


@pytest.mark.parametrize("delay", [-1, 0.5, np.nan, np.inf])
def test_a_delay_that_is_not_whole_is_refused(delay):
    for function in (calc_exact_boundary, calc_boundary_peak):
        with pytest.raises(ValueError, match="delay_samples must be a whole number"):
            function(delay)


def test_what_cannot_be_is_refused():
    with pytest.raises(ValueError, match="beta must be at least 0 and finite, is -1"):
        calc_exact_alpha(-1.0, 0)
    with pytest.raises(ValueError, match=r"angle must be in \[0, 1\.57"):
        calc_boundary_point(1.6, 0)
    with pytest.raises(ValueError, match="points must be at least 2 and finite, is 1"):
        calc_exact_boundary(0, 1)
