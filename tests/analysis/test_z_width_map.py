"""Z-width maps agree with the exact boundaries of a sampled spring and damper."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from matplotlib.figure import Figure
from sampled_loop import SampledLoop, refuse_stiff
from scipy.optimize import minimize_scalar

from drake_haptics.analysis import HeldBounds, SerialExecutor, StudyError, calc_z_width
from drake_haptics.analysis.exact_boundary import calc_boundary_peak
from drake_haptics.analysis.z_width_map import ZWidth
from drake_haptics.bounds.sampled_spring import (
    calc_passive_damping,
    calc_sampled_stiffness,
)

SERIAL = SerialExecutor()
# In these units stiffness is α and damping is β.
UNIT = SampledLoop(mass=1.0, period_s=1.0)


def make_map(radius, stiffness=(1.0, 2.0, 4.0)) -> ZWidth:
    radius = np.array(radius, dtype=float)
    damping = np.arange(len(radius), dtype=float)
    return ZWidth(np.array(stiffness), damping, radius, np.full(radius.shape, np.nan))


def test_the_map_has_the_polynomials_growth_at_each_point():
    K, B = np.linspace(0.05, 0.8, 4), np.linspace(0.1, 1.5, 3)
    found = calc_z_width(UNIT, K, B, executor=SERIAL)
    assert found.spectral_radius.shape == (3, 4)
    for i, beta in enumerate(B):
        for j, alpha in enumerate(K):
            jury = [2.0, alpha + beta - 4.0, 2.0 + alpha, -beta]
            radius = np.abs(np.roots(jury)).max()
            assert found.spectral_radius[i, j] == pytest.approx(radius, rel=1e-9)
            # Jury: 0 < α < 2 β (2 - β)/(2 + β).
            is_stable = alpha < 2.0 * beta * (2.0 - beta) / (2.0 + beta)
            assert (found.spectral_radius[i, j] < 1.0) == is_stable


def test_the_edge_of_the_map_is_jurys_boundary():
    m, T = 0.1, 1e-3
    loop = SampledLoop(m, T)
    K = np.linspace(1000.0, 80000.0, 80)
    B = np.linspace(10.0, 150.0, 15)
    edge = calc_z_width(loop, K, B).largest_stable_stiffness()
    exact = [calc_sampled_stiffness(m, b, T) for b in B]
    # Within the grid's 1000 N/m by far: the crossing is interpolated.
    np.testing.assert_allclose(edge, exact, rtol=1e-4)


@pytest.mark.parametrize("delay", range(5))
def test_the_largest_stiffness_of_all_is_the_known_maximum(delay):
    loop, peak = SampledLoop(1.0, 1.0, delay=delay), calc_boundary_peak(delay)
    K = peak.alpha * np.linspace(0.95, 1.02, 15)
    B = peak.beta * np.linspace(0.97, 1.03, 3)

    def edge(b: float) -> float:
        row = calc_z_width(loop, K, [b], executor=SERIAL).largest_stable_stiffness()
        return float(row[0])

    best = minimize_scalar(lambda b: -edge(b), bounds=(B[0], B[-1]), method="bounded")
    assert -best.fun == pytest.approx(peak.alpha, rel=1e-4)


def test_physical_damping_and_a_sample_of_delay_move_the_edge_as_measured():
    # Of a mass of 0.1 kg at 1 kHz with b = 0.5: K from eigenvalues, to 0.1 N/m.
    for delay, expected in [(0, 1000.8), (1, 333.8)]:
        K = expected * np.linspace(0.5, 1.5, 60)
        loop = SampledLoop(0.1, 1e-3, damping=0.5, delay=delay)
        found = calc_z_width(loop, K, [0.0], executor=SERIAL)
        assert found.largest_stable_stiffness()[0] == pytest.approx(expected, abs=0.1)


def test_the_crossing_is_the_first_and_interpolated():
    found = make_map(
        [
            [0.8, 1.2, 0.9],  # stable again later: not counted
            [0.9, 0.95, 1.05],
            [0.9, 1.0, 1.1],
            [0.5, 0.6, 0.7],
            [1.1, 0.9, 0.9],
            [0.9, math.nan, 1.1],
            [math.nan, 0.9, 1.1],
        ]
    )
    expected = [1.5, 3.0, 2.0, math.inf, math.nan, math.nan, math.nan]
    np.testing.assert_allclose(found.largest_stable_stiffness(), expected)


def test_points_that_cannot_be_evaluated_stay_open_with_their_reason():
    found = calc_z_width(
        refuse_stiff, [100.0, 200.0, 400.0], [0.0, 1.0], executor=SERIAL
    )
    assert np.isnan(found.spectral_radius[:, 2]).all()
    assert (found.spectral_radius[:, :2] == 0.9).all()
    reason = "no equilibrium at 400 N/m"
    assert found.reasons == {(0, 2): reason, (1, 2): reason}


def test_a_map_without_a_point_is_an_error():
    with pytest.raises(ValueError, match=r"no point .* no equilibrium at 400 N/m"):
        calc_z_width(refuse_stiff, [400.0, 500.0], [0.0], executor=SERIAL)


def test_a_radius_that_is_no_number_is_a_reason():
    found = calc_z_width(
        lambda k, b: {"spectral_radius": math.inf if k > 1 else 0.5},
        [1.0, 2.0],
        [0.0],
        executor=SERIAL,
    )
    assert found.reasons == {(0, 1): "the spectral radius is inf"}


def test_a_defect_of_evaluate_is_an_error():
    with pytest.raises(StudyError, match="KeyError: 'spectral_radius'"):
        calc_z_width(lambda k, b: {}, [1.0], [0.0], executor=SERIAL)


@pytest.mark.parametrize(
    ("K", "message"),
    [
        ([], r"stiffness must be of shape \(n,\), is of shape \(0,\)"),
        ([[1.0]], "stiffness must be of shape"),
        ([1.0, 1.0], "stiffness must rise"),
        ([2.0, 1.0], "stiffness must rise"),
        ([1.0, math.nan], "stiffness must rise and be finite"),
    ],
)
def test_a_grid_that_is_none_is_refused(K, message):
    with pytest.raises(ValueError, match=message):
        calc_z_width(UNIT, K, [1.0])


def test_a_finer_map_takes_what_its_store_has(tmp_path):
    store, seen = tmp_path / "map.jsonl", []
    coarse = calc_z_width(UNIT, [0.1, 0.3], [0.5, 0.7], executor=SERIAL, store=store)
    fine = calc_z_width(
        UNIT,
        [0.1, 0.2, 0.3],
        [0.5, 0.7],
        executor=SERIAL,
        store=store,
        progress=lambda *at: seen.append(at),
    )
    assert seen[0] == (4, 6)
    np.testing.assert_array_equal(fine.spectral_radius[:, ::2], coarse.spectral_radius)
    other = SampledLoop(1.0, 1.0, delay=1)
    with pytest.raises(ValueError, match=r"_Point\(sampled_loop\.SampledLoop\) with"):
        calc_z_width(other, [0.1], [0.5], executor=SERIAL, store=store)


def test_a_map_comes_back_from_json():
    found = calc_z_width(refuse_stiff, [100.0, 400.0], [0.0, 1.0], executor=SERIAL)
    text = json.dumps(found.to_dict(), allow_nan=False)
    again = ZWidth.from_dict(json.loads(text))
    for name in ("stiffness", "damping", "spectral_radius", "passive_damping"):
        np.testing.assert_array_equal(getattr(again, name), getattr(found, name))
    assert again.reasons == found.reasons


# Bounds and picture.


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize("damping", [0.0, 0.3, 1.2])
def test_the_passivity_line_is_where_the_condition_on_a_grid_is_met(delay, damping):
    b, T = 2.0, 1e-3
    bounds = HeldBounds(held_damping=b, period_s=T, delay_s=delay * T)
    K = bounds.calc_passive_stiffness(damping)
    needed = SampledLoop(0.1, T, b, delay)(K, damping)["passive_damping"]
    assert needed <= b * (1.0 + 1e-6)
    if delay == 0 or damping == 0.0:
        assert needed == pytest.approx(b, rel=1e-3)
    if delay == 0:
        assert calc_passive_damping(K, damping, T) == pytest.approx(b)


def test_nothing_is_passive_with_more_sampled_damping_than_there_is():
    assert HeldBounds(1.0, 1e-3).calc_passive_stiffness(1.5) == 0.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((1.0, 0.0), "period_s must be positive and finite, is 0"),
        ((-1.0, 1e-3), "held_damping must be at least 0 and finite, is -1"),
        ((1.0, 1e-3, math.nan), "delay_s must be at least 0 and finite, is nan"),
    ],
)
def test_bounds_that_cannot_be_are_refused(values, message):
    with pytest.raises(ValueError, match=message):
        HeldBounds(*values)


def labels(axes) -> set[str]:
    return {text.get_text() for text in axes.get_legend().get_texts()}


def test_the_picture_has_region_lines_and_gains():
    b, T = 0.5, 1e-3
    loop = SampledLoop(0.1, T, damping=b)
    found = calc_z_width(
        loop, np.linspace(100, 4000, 20), np.linspace(0, 2, 9), executor=SERIAL
    )
    axes = Figure().add_subplot()
    shown = found.plot(axes, bounds=HeldBounds(b, T), gains=(5000.0, 1.0))
    assert shown is axes
    assert labels(axes) == {
        "stable",
        "unstable",
        "eigenvalue: one reaches 1",
        "formula: (b + B)/(T/2 + t_d)",
        "passivity: (b - |B|)/(T/2 + t_d)",
        "passivity: of the felt impedance",
        "the scene's gains",
    }
    assert axes.get_xlim() == (100.0, 5000.0)
    assert axes.get_xscale() == "linear"
    stability, passivity = (
        line for line in axes.lines if "T/2" in str(line.get_label())
    )
    np.testing.assert_allclose(
        stability.get_xdata(), (b + stability.get_ydata()) / (T / 2)
    )
    # What the loop feels like needs K T/2 + |B|, as the formula says.
    curve = axes.collections[-1].get_paths()[0].vertices
    inside = curve[:, 1] > 1e-9
    np.testing.assert_allclose(
        curve[inside, 0], (b - curve[inside, 1]) * 2 / T, atol=20.0
    )
    assert passivity.get_xdata().max() == pytest.approx(2 * b / T)


def test_open_points_are_drawn_as_such_and_grids_by_a_factor_are_logarithmic():
    found = calc_z_width(
        refuse_stiff, [1.0, 20.0, 400.0], [0.1, 0.2, 0.4], executor=SERIAL
    )
    axes = found.plot(Figure().add_subplot())
    assert labels(axes) == {"stable", "not evaluated"}
    (open_points,) = (x for x in axes.lines if x.get_label() == "not evaluated")
    np.testing.assert_array_equal(open_points.get_xdata(), [400.0] * 3)
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    axes.figure.canvas.draw()


def test_gains_without_stiffness_leave_a_logarithmic_axis_above_zero(recwarn):
    found = calc_z_width(UNIT, [0.1, 0.2, 0.4], [0.0, 0.5], executor=SERIAL)
    axes = found.plot(Figure().add_subplot(), gains=(0.0, 0.5))
    assert axes.get_xlim() == (0.1, 0.4)
    assert not recwarn.list


def test_a_map_that_is_nowhere_stable_can_be_drawn():
    axes = make_map([[1.5, 2.0, 3.0], [1.2, 1.4, 1.8]]).plot(
        Figure().add_subplot(), gains=(1.0, 1.0)
    )
    assert labels(axes) == {"unstable", "the scene's gains"}


def test_a_row_cannot_be_drawn():
    with pytest.raises(ValueError, match="two stiffnesses and two dampings"):
        make_map([[0.9, 0.95, 1.0]]).plot()
