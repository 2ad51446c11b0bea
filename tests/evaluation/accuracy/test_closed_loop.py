"""Energy from nothing, and the largest stable stiffness."""

import dataclasses
import math
import sys
from functools import partial

import numpy as np
import pytest
from box_scenes import over_a_plate

from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.held_scene import hold_scene
from drake_haptics.evaluation.accuracy import closed_loop
from drake_haptics.evaluation.accuracy.closed_loop import (
    PressedPlace,
    find_pressed_place,
    find_stable_stiffness,
    measure_created_energy,
)
from drake_haptics.simulation.run import make_simulator, run

PRESS = [(0.0, 0.0, 0.0, 0.015), (0.15, 0.0, 0.0, 0.006), (0.3, 0.01, 0.0, 0.006)]


def test_a_tool_in_the_air_makes_no_energy(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05), (0.3, 0.02, 0.0, 0.05)])
    # Rounding only: the handle moves, and pulls the tool along.
    assert 0.0 <= measure_created_energy(scene, 0.3) < 1e-12


def test_a_loop_that_is_not_stable_makes_energy(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    stable_J = measure_created_energy(scene, 0.3)
    scene.coupling.stiffness_N_per_m, scene.device.rate_hz = 1e5, 250.0
    # Twice what its own spring can hold at the device's 8.5 N, 0.36 mJ, and more.
    assert measure_created_energy(scene, 0.3) > 10e-3 > 10.0 * stable_J > 0.0


def test_a_loop_that_diverges_makes_infinitely_much(tmp_path, monkeypatch):
    def make_broken_simulator(haptic, context):
        simulator = make_simulator(haptic, context)
        tool = haptic.loop.haptic_tool
        context = tool.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        context.get_mutable_discrete_state_vector().SetAtIndex(9, np.nan)
        return simulator

    module = sys.modules["drake_haptics.simulation.run"]
    monkeypatch.setattr(module, "make_simulator", make_broken_simulator)
    assert measure_created_energy(over_a_plate(tmp_path, PRESS), 0.1) == math.inf


def test_ctrl_c_leaves_no_half_a_result(tmp_path, monkeypatch):
    def interrupt(root):
        if root.get_time() > 0.02:
            raise KeyboardInterrupt

    monkeypatch.setattr(closed_loop, "run", partial(run, on_tick=interrupt))
    with pytest.raises(KeyboardInterrupt):
        measure_created_energy(over_a_plate(tmp_path, PRESS), 0.1)


def test_motions_die_out_below_the_limit_and_grow_above(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    # From anywhere; here from where it is a little too stiff.
    place = PressedPlace(0.3, 1e6)
    found_N_per_m, why_not = find_stable_stiffness(scene, place)
    assert why_not == ""
    held = hold_scene(scene, place.time_s)
    below, above = (
        analyze_held_scene(
            held,
            dataclasses.replace(
                scene.coupling, stiffness_N_per_m=share * found_N_per_m
            ),
        ).growth
        for share in (0.97, 1.03)
    )
    assert below < 1.0 < above


def test_the_pressed_place_is_where_the_tool_is_pressed(tmp_path):
    place = find_pressed_place(over_a_plate(tmp_path, PRESS))
    # Before 0.05 s it is farther than the tolerance.
    assert 0.05 < place.time_s <= 0.3


def test_says_why_there_is_no_limit(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    reason = "it rocks for ever"
    assert find_stable_stiffness(scene, reason) == (None, reason)
    late_N_per_m, why_not = find_stable_stiffness(scene, PressedPlace(7.0, 1e5))
    assert late_N_per_m is None and "time_s must be on" in why_not


def test_a_loop_of_two_rates_has_no_limit_that_could_be_told(tmp_path):
    scene = over_a_plate(tmp_path, PRESS)
    scene.contact.query_rate_hz = 500.0
    found_N_per_m, why_not = find_stable_stiffness(scene, PressedPlace(0.3, 1e5))
    assert found_N_per_m is None
    assert "another rate than the loop" in why_not
