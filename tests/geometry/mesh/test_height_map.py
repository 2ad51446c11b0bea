"""Heights of first touch against geometry known in closed form."""

import numpy as np
import pytest
import trimesh

from drake_haptics.geometry.mesh.height_map import TouchMap
from drake_haptics.geometry.mesh.mesh import Mesh


def intake(mesh, shift=(0, 0, 0)):
    return Mesh.from_arrays(mesh.vertices + np.array(shift), mesh.faces)


PLATE = intake(trimesh.creation.box([0.2, 0.2, 0.02]))
BALL = intake(trimesh.creation.icosphere(subdivisions=4, radius=0.03))


def test_a_cube_lands_on_a_plate():
    cube = intake(trimesh.creation.box([0.02, 0.02, 0.02]), (0.5, 0, 0.1))
    touch = TouchMap(cube, PLATE, np.array([-0.5, 0.0]), 0.02)
    for offset in ([0, 0], [0.02, 0], [-0.01, 0.01]):
        assert touch.calc_height(np.array(offset)) == pytest.approx(0.01 - 0.09)


def test_beside_the_environment_it_passes_by():
    cube = intake(trimesh.creation.box([0.02, 0.02, 0.02]))
    touch = TouchMap(cube, PLATE, np.array([0.13, 0.0]), 0.04)
    assert touch.calc_height(np.array([0.0, 0.0])) == -np.inf
    assert np.isfinite(touch.calc_height(np.array([-0.03, 0.0])))


@pytest.mark.parametrize("offset", [(0, 0), (0.02, 0), (-0.01, 0.03), (0.0, -0.04)])
def test_a_ball_lands_on_a_ball(offset):
    touch = TouchMap(BALL, BALL, np.zeros(2), 0.04)
    expected = np.sqrt(0.06**2 - np.hypot(*offset) ** 2)
    assert touch.calc_height(np.array(offset)) == pytest.approx(expected, abs=1e-3)


def test_a_tip_finer_than_the_grid_is_not_missed():
    tip = trimesh.creation.cone(0.0005, 0.05)
    tip.apply_transform(np.diag([1.0, -1.0, -1.0, 1.0]))
    head = trimesh.creation.box([0.2, 0.2, 0.01])
    needle = trimesh.util.concatenate([tip, head])
    touch = TouchMap(intake(needle), PLATE, np.array([0.0, 0.0]), 0.01)
    assert touch.calc_height(np.zeros(2)) == pytest.approx(0.01 + 0.05, abs=1e-9)


def test_a_mug_is_touched_at_its_bottom_or_its_rim():
    wall = trimesh.creation.annulus(0.03, 0.034, 0.08)
    mug = trimesh.util.concatenate([wall, trimesh.creation.box([0.04, 0.04, 0.002])])
    stick = intake(trimesh.creation.box([0.004, 0.004, 0.1]))
    touch = TouchMap(stick, intake(mug), np.zeros(2), 0.035)
    assert touch.calc_height(np.zeros(2)) == pytest.approx(0.001 + 0.05)
    assert touch.calc_height(np.array([0.032, 0])) == pytest.approx(0.04 + 0.05)
