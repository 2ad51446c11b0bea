"""A haptic loop makes no energy but what the sampling of its forces explains."""

import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from energy_rig import assert_nothing_is_created

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
)
from drake_haptics.simulation.run import run

HIGH, LOW = TOOL_HALF_HEIGHT + 0.01, TOOL_HALF_HEIGHT - 0.006
PATHS = {
    "press": [(0.0, 0, 0, HIGH), (0.3, 0, 0, LOW), (0.7, 0, 0, LOW), (1.0, 0, 0, HIGH)],
    "slide": [(0.0, 0, 0, HIGH), (0.3, 0, 0, LOW), (1.0, 0.05, 0.02, LOW)],
    "tap": [(0.1 * i, 0, 0, HIGH if i % 2 == 0 else LOW) for i in range(9)],
}


def energies(scene):
    """Returns the books of a run."""
    return run(BuildHapticDiagram(scene), 1.2, energy=True).to_dict()["energy_J"]


@pytest.mark.parametrize("grip", ["nominal", "firm"])
@pytest.mark.parametrize("path", PATHS)
def test_a_ball_on_a_plate(tmp_path, path, grip):
    books = energies(over_a_plate(tmp_path, PATHS[path], tool="ball", grip=grip))
    contact = books["contact"]
    assert contact["in"] > 1e-5
    assert_nothing_is_created(books)
    if path == "tap":
        # The plate is met within a tick, and has stored energy before it was felt.
        assert 0.3 * contact["bound"] < contact["created"] < contact["bound"]


@pytest.mark.parametrize("path", ["press", "tap"])
def test_a_cube_flat_on_a_plate(tmp_path, path):
    books = energies(over_a_plate(tmp_path, PATHS[path], tool="cube"))
    assert books["contact"]["in"] > 1e-4
    assert_nothing_is_created(books)


@pytest.mark.parametrize("path", PATHS)
def test_effects_that_only_take_or_store(tmp_path, path):
    scene = over_a_plate(tmp_path, PATHS[path], tool="ball")
    scene.effects = Effects(
        friction=FrictionParameters(),
        braking=BrakingParameters(),
        gravity=GravityParameters(),
    )
    books = energies(scene)
    assert books["braking"]["damped"] > 0.0
    assert_nothing_is_created(books)
