"""Poles in the z plane."""

import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest
from matplotlib import pyplot
from wall_loop import make_loop

from drake_haptics.analysis import find_modes, linearize_sampled, plot_poles


@pytest.fixture
def linear():
    loop = make_loop(1100.0)
    return linearize_sampled(loop, loop.CreateDefaultContext())


def read_points(axes):
    """All points drawn as markers, by their label, complex."""
    return {
        artist.get_label(): artist.get_offsets() @ [1.0, 1j]
        for artist in axes.collections
    }


def test_every_pole_is_drawn_where_it_is(linear):
    axes = plot_poles(linear)
    points = read_points(axes)
    drawn = np.sort_complex(np.concatenate(list(points.values())))
    np.testing.assert_allclose(drawn, np.sort_complex(linear.eigenvalues()), atol=1e-12)
    assert np.all(np.abs(points["unstable"]) > 1.0)
    assert len(points["neither: memory, quaternion length"]) == 2
    pyplot.close(axes.figure)


def test_it_draws_into_given_axes(linear):
    axes = pyplot.figure().add_subplot()
    assert plot_poles(linear, axes) is axes
    assert f"{linear.spectral_radius():.6f}" in axes.get_title()
    pyplot.close(axes.figure)


def test_lines_of_equal_damping_and_frequency_are_those_of_a_mode(linear):
    axes = plot_poles(linear)
    lines = [line.get_xydata() @ [1.0, 1j] for line in axes.lines[1:]]
    T = linear.period_s
    ratios, frequencies = set(), set()
    for z in lines:
        z = z[(z.imag > 1e-9) & (np.abs(z) < 1.0 - 1e-9)]
        if not len(z):
            continue
        s = np.log(z) / T
        for values, found in [
            (-s.real / np.abs(s), ratios),
            (np.abs(s) / (2.0 * np.pi), frequencies),
        ]:
            if np.ptp(values) < 1e-6 * np.abs(values).max():
                found.add(round(float(values.mean()), 6))
    assert ratios == {round(0.1 * i, 6) for i in range(1, 10)}
    assert frequencies == {50.0 * i for i in range(1, 11)}
    pyplot.close(axes.figure)


def test_modes_and_poles_are_of_one_map(linear):
    assert abs(find_modes(linear)[0].eigenvalue) == linear.spectral_radius()
