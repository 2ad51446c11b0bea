"""Limits of stiffness: what they say where there is one and where there is none."""

import json
import math
from dataclasses import replace

import pytest
from held_samples import load_held, make_limits

from drake_haptics.analysis import stiffness_limits
from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.sampled_wall import SampledWall
from drake_haptics.analysis.stiffness_limits import find_stiffness_limits, format_limit


@pytest.fixture(scope="module")
def held():
    return load_held("hammer_block")


@pytest.fixture(scope="module")
def limits(held):
    shares = []
    found = find_stiffness_limits(held, "translation", "a rigid wall", shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0 and len(shares) > 5
    return found


def test_the_limit_is_between_what_dies_out_and_what_grows(held, limits):
    still = replace(
        held, scene=replace(held.scene, tool=replace(held.scene.tool, mass_kg=1e15))
    )
    for factor, is_stable in [(0.999, True), (1.001, False)]:
        coupling = replace(
            held.scene.coupling, stiffness_N_per_m=factor * limits.eigenvalue
        )
        growth = analyze_held_scene(still, coupling).growth
        assert (growth < 1.0) == is_stable


def test_one_axis_and_formula_are_those_of_device_and_hand(held, limits):
    assert limits.stiffness == 800.0 and limits.damping == 2.0
    assert limits.unit == "N/m"
    assert limits.gain_margin == limits.eigenvalue / 800.0
    # (b + B) / (T/2)
    b = limits.formula * 0.5e-3 - 2.0
    assert 0.0 < b < 15.0 + 5.0
    # The axis reaches its limit at a stiffness that is near that of the formula.
    assert limits.one_axis == pytest.approx(limits.formula, rel=0.1)
    assert SampledWall(
        mass=1.0, damping=b, period_s=1e-3, stiffness=limits.formula, wall_damping=2.0
    ).calc_spectral_radius() == pytest.approx(1.0, abs=1e-3)


def test_what_limits_it_is_said_in_words_without_its_growth(limits):
    rate, _, parts = limits.limited_by.partition("; mostly ")
    assert 20.0 < float(rate.removesuffix(" Hz")) < 500.0
    assert "joint" in parts and "device/" not in parts
    assert "%" not in limits.limited_by


def test_a_range_without_a_limit_says_so(held, monkeypatch):
    monkeypatch.setattr(stiffness_limits, "_RANGE", 2.0)
    limits = find_stiffness_limits(held, "translation")
    assert limits.eigenvalue == math.inf and math.isnan(limits.simulated)
    assert "nothing in the range" in limits.limited_by
    data = limits.to_dict()
    json.dumps(data, allow_nan=False)
    assert data["eigenvalue"] is None and data["simulated"] is None
    assert data["gain_margin"] is None and data["one_axis"] == limits.one_axis


def test_where_nothing_can_be_told_beyond_it_says_why(held, monkeypatch):
    true = stiffness_limits.analyze_held_scene

    def analyze(held, coupling):
        if coupling.stiffness_N_per_m > 2000.0:
            raise ValueError("the arm does not reach that far")
        return true(held, coupling)

    monkeypatch.setattr(stiffness_limits, "analyze_held_scene", analyze)
    found = find_stiffness_limits(held, "translation")
    assert found.eigenvalue == pytest.approx(2000.0, rel=1e-3)
    assert math.isnan(found.simulated)
    assert found.limited_by.endswith("told: the arm does not reach that far")


def test_where_another_gain_is_too_large_says_what_grows(held):
    coupling = replace(held.scene.coupling, stiffness_N_per_m=1e5)
    stiff = replace(held, scene=replace(held.scene, coupling=coupling))
    limits = find_stiffness_limits(stiff, "rotation", "a rigid wall")
    assert limits.eigenvalue == 0.0 and limits.gain_margin == 0.0
    assert " Hz; mostly " in limits.limited_by


@pytest.mark.parametrize("kind", ["translation", "rotation"])
def test_a_coupling_without_that_stiffness_has_no_limit(held, kind):
    coupling = replace(
        held.scene.coupling, stiffness_N_per_m=0.0, rotational_stiffness_Nm_per_rad=0.0
    )
    loose = replace(held, scene=replace(held.scene, coupling=coupling))
    with pytest.raises(ValueError, match=r"coupling\.\w+ must be above 0, is 0"):
        find_stiffness_limits(loose, kind)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["coupling"], "kind must be 'translation' or 'rotation', is 'coupling'"),
        (["rotation", "wall"], "against must be 'this contact' or .*, is 'wall'"),
    ],
)
def test_a_kind_or_a_body_that_is_none_is_refused(held, arguments, message):
    with pytest.raises(ValueError, match=message):
        find_stiffness_limits(held, *arguments)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (249069.7, "249,070"),
        (1234567.0, "1,234,600"),
        (109.083, "109.08"),
        (1.0, "1"),
        (math.inf, "none found"),
        (math.nan, "not seen"),
        (0.0, "none is stable"),
    ],
)
def test_limits_are_written_without_exponents(value, text):
    assert format_limit(value) == text


def test_the_margin_is_of_the_scenes_stiffness():
    assert make_limits(1600.0).gain_margin == 2.0
