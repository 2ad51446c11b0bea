"""The bound on a spring on an encoder, against the work of simulated paths."""

import numpy as np
import pytest

from drake_haptics.analysis.wall_bounds import calc_quantization_bounds

T, DAMPING, RESOLUTION = 1e-3, 0.5, 3e-5
# Finer than enough, about enough, coarser than enough.
FRICTIONS = [0.004, 0.015, 0.06]


def calc_gain(path, K, friction, offset):
    """Returns the work that a sampled spring does along a closed path, less the losses.

    The path is of positions a period apart, between them at even speed; the spring's
    force comes of the position that an encoder counts, and is held for a period.
    """
    counted = np.round(path / RESOLUTION + offset) * RESOLUTION
    moved = np.diff(path, append=path[0])
    work = -K * counted * moved
    lost = DAMPING * moved**2 / T + friction * np.abs(moved)
    return (work - lost).sum()


def make_paths():
    """Closed paths at random: in and out, and wandering, from counts to millimeters."""
    random = np.random.default_rng(5)
    for size in np.geomspace(0.1, 300.0, 60) * RESOLUTION:
        yield np.array([0.0, size]), random.uniform()
        for _ in range(4):
            samples = random.integers(2, 40)
            yield size * random.normal(size=samples).cumsum(), random.uniform()
            # Fast in one period, slowly back: all rounding works for it.
            yield size * random.uniform(size=samples), random.uniform()


@pytest.mark.parametrize("friction", FRICTIONS)
def test_no_path_gains_from_a_spring_of_the_bound(friction):
    (K,) = calc_quantization_bounds(DAMPING, friction, T, [RESOLUTION]).stiffness
    assert max(calc_gain(path, K, friction, o) for path, o in make_paths()) <= 1e-15


@pytest.mark.parametrize("friction", FRICTIONS)
def test_in_and_out_within_two_samples_gains_beyond_it(friction):
    (K,) = calc_quantization_bounds(DAMPING, friction, T, [RESOLUTION]).stiffness
    paths = [
        # Out by a little less than is counted, or so far that rounding is nothing.
        (np.array([0.0, RESOLUTION * size]), offset)
        for size in (1e-3, 1.0, 1e4)
        for offset in (0.0, 0.4999, 0.4999999)
    ]
    gains = [calc_gain(path, 1.05 * K, friction, offset) for path, offset in paths]
    assert max(gains) > 0.0


def test_a_finer_encoder_than_needed_gains_nothing():
    bounds = calc_quantization_bounds(DAMPING, 0.015, T, np.geomspace(1e-6, 1e-3, 31))
    fine = bounds.resolutions <= bounds.sufficient_resolution
    assert bounds.sufficient_resolution == pytest.approx(3e-5)
    assert bounds.stiffness[fine] == pytest.approx(1000.0)
    assert (np.diff(bounds.stiffness[~fine]) < 0).all()
    assert bounds.stiffness[-1] == pytest.approx(2 * 0.015 / 1e-3)


def test_without_damping_no_encoder_is_fine_enough():
    bounds = calc_quantization_bounds(0.0, 0.015, T, [1e-5])
    assert bounds.sufficient_resolution == np.inf
    assert bounds.stiffness == [0.0]


def test_the_plot_shows_the_curve_and_its_knee():
    pytest.importorskip("matplotlib").use("Agg")
    bounds = calc_quantization_bounds(DAMPING, 0.015, T, np.geomspace(1e-6, 1e-3, 31))
    curve, knee = bounds.plot().lines
    assert np.array_equal(curve.get_ydata(), bounds.stiffness)
    assert knee.get_xdata()[0] == bounds.sufficient_resolution
    assert bounds.to_dict()["stiffness"] == bounds.stiffness.tolist()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.5, 0.1, 0.0, [1e-5]), "period_s must be positive and finite, is 0"),
        ((0.5, 0.1, T, []), "resolutions must be at least one"),
        ((0.5, 0.1, T, [0.0]), "resolutions must be at least one"),
        ((-0.5, 0.1, T, [1e-5]), "held_damping must be at least 0 and finite"),
        ((0.5, -0.1, T, [1e-5]), "friction must be at least 0 and finite"),
    ],
)
def test_what_cannot_be_is_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        calc_quantization_bounds(*arguments)
