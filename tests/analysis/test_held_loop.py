"""A held loop's eigenvalues, against its own simulation and in other processes."""

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from held_samples import load_held

from drake_haptics.analysis.held_loop import (
    CouplingGrowth,
    analyze_held_scene,
    replace_gains,
)
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.z_width_map import calc_z_width
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

# Stiffness and damping of translation: soft, the scenes' own, bouncing, stiff, and
# beyond what is stable against a rigid wall.
GAINS = [(300.0, 0.0), (800.0, 2.0), (3e3, 0.5), (1.2e4, 4.0), (4e4, 2.0)]
TIME_S = 0.344


@pytest.fixture(scope="module")
def growth():
    return CouplingGrowth(load_scene(find_scene("hammer_block")), TIME_S)


@pytest.mark.parametrize("gains", GAINS)
@pytest.mark.parametrize("name", ["sphere_pen", "hammer_block"])
def test_motions_grow_as_fast_in_simulation(name, gains):
    held = load_held(name)
    loop = analyze_held_scene(held, replace_gains(held.scene.coupling, *gains))
    assert loop.measure_growth() == pytest.approx(loop.growth, abs=1e-4)


def test_a_loop_that_is_unstable_grows_in_simulation():
    held = load_held("hammer_block").against_rigid_wall()
    loop = analyze_held_scene(held, replace_gains(held.scene.coupling, 3e4, 2.0))
    assert loop.growth > 1.001
    assert loop.measure_growth() == pytest.approx(loop.growth, abs=1e-4)


def test_the_growth_of_a_coupling_can_be_pickled(growth):
    copy = pickle.loads(pickle.dumps(growth))
    assert copy == growth
    assert copy(800.0, 2.0) == growth(800.0, 2.0)


def test_it_is_the_growth_of_the_held_loop(growth):
    held = load_held("hammer_block")
    assert held.time_s == pytest.approx(TIME_S, abs=1e-9)
    expected = analyze_held_scene(held, replace_gains(held.scene.coupling, 2e3, 1.0))
    assert growth(2e3, 1.0)["spectral_radius"] == pytest.approx(
        expected.growth, abs=1e-9
    )


def test_the_order_of_points_does_not_matter(growth):
    points = [(K, B) for K in (500.0, 5e3, 5e4) for B in (0.0, 3.0)]
    forwards = {point: growth(*point) for point in points}
    backwards = {point: growth(*point) for point in reversed(points)}
    assert forwards == backwards
    # Another scene in between; then this one is held again.
    CouplingGrowth(growth.scene, 1.0)(800.0, 2.0)
    assert {point: growth(*point) for point in points} == forwards


def test_a_map_is_the_same_in_any_process(growth):
    grid = {"stiffness": [500.0, 5e3, 5e4], "damping": [0.5, 3.0]}
    here = calc_z_width(growth, **grid, executor=SerialExecutor())
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        there = calc_z_width(growth, **grid, executor=pool)
    np.testing.assert_array_equal(here.spectral_radius, there.spectral_radius)
    assert not here.reasons and np.isfinite(here.spectral_radius).all()


def test_a_device_near_its_limit_is_linearized_all_the_same():
    # The point beside the state at which derivatives are checked is, for the third of
    # these stiffnesses, where the device's torque just reaches its limit.
    held = load_held("cup_spoon")
    for stiffness in (3.0e4, 3.003e4, 30065.76, 3.01e4):
        coupling = replace_gains(held.scene.coupling, stiffness, 2.0)
        assert 0.98 < analyze_held_scene(held, coupling).growth < 1.0
