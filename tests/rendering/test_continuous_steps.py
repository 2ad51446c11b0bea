"""Integrators of a continuous plant feel contact only where they step into it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from plant_scenes import PLANTS, PlantScene
from pydrake.geometry import Box
from pydrake.math import RigidTransform
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.analysis import (
    ApplySimulatorConfig,
    GetIntegrationSchemes,
    SimulatorConfig,
)

from drake_haptics import AddHapticRendering
from drake_haptics.scene.schema import ContactParameters

TOLERANCE_M = 2e-3
SPEED_M_PER_S = 1.0
SAFE_STEP_S = TOLERANCE_M / SPEED_M_PER_S
HALF_CUBE_M = 0.01
SCHEMES = ["runge_kutta3"] + [s for s in ("cenic",) if s in GetIntegrationSchemes()]


def throw_at_a_plate(
    scheme: str, max_step_s: float, height_m: float, accuracy: float = 1e-3
) -> tuple[float, float]:
    """Returns height (m) and speed (m/s) at the end of a cube thrown at a plate.

    The plate's top is z = 0, and it is 10 mm thick.

    Args:
        scheme: Of the integrator, with error control.
        max_step_s: `max_step_size`.
        height_m: Of the cube's middle when it starts.
        accuracy: Of the error control.
    """
    scene = PlantScene(PLANTS["continuous"])
    plate = scene.plant.AddRigidBody("plate", SpatialInertia.SolidCubeWithDensity(1, 1))
    scene.touchable(plate, Box(0.2, 0.2, 0.01), RigidTransform([0, 0, -0.005]), "plate")
    scene.plant.WeldFrames(scene.plant.world_frame(), plate.body_frame())
    side = 2.0 * HALF_CUBE_M
    scene.add("cube", Box(side, side, side), side=side)
    scene.finalize(gravity=0.0)
    AddHapticRendering(
        scene.builder,
        scene.plant,
        scene.scene_graph,
        "cube",
        contact=ContactParameters(stiffness_N_per_m=2e4, tolerance_m=TOLERANCE_M),
    )
    scene.start(cube=RigidTransform([0.0, 0.0, height_m]))
    scene.plant.SetVelocities(scene.context, [0.0, 0.0, 0.0, 0.0, 0.0, -SPEED_M_PER_S])
    config = SimulatorConfig(
        integration_scheme=scheme,
        max_step_size=max_step_s,
        accuracy=accuracy,
        use_error_control=True,
    )
    ApplySimulatorConfig(config, scene.simulator)
    scene.simulator.AdvanceTo(0.2)
    return float(scene.pose("cube").translation()[2]), float(scene.velocity("cube")[5])


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.75])
def test_a_step_of_tolerance_over_speed_meets_the_plate(scheme, share):
    """Wherever in a step the cube comes to the tolerance; it comes back out."""
    height_m = 0.06 + share * SAFE_STEP_S * SPEED_M_PER_S
    end_m, _ = throw_at_a_plate(scheme, SAFE_STEP_S, height_m)
    assert end_m > HALF_CUBE_M + TOLERANCE_M


@pytest.mark.parametrize("scheme", SCHEMES)
def test_drakes_largest_step_goes_through_the_plate(scheme):
    """As docs/compose.md warns: no accuracy asks for what no step has met."""
    end_m, _ = throw_at_a_plate(scheme, SimulatorConfig().max_step_size, 0.06)
    assert end_m < -0.01 - HALF_CUBE_M - TOLERANCE_M


@pytest.mark.skipif("cenic" not in SCHEMES, reason="this Drake has no CENIC")
def test_the_page_tells_how_fast_the_cube_comes_back():
    page = (Path(__file__).parents[2] / "docs" / "compose.md").read_text("utf-8")
    told = re.findall(r"([\d.]+) m/s", page.split("CENIC also takes")[1])[:3]
    runs = [("cenic", 1e-3), ("runge_kutta3", 1e-3), ("cenic", 1e-6)]
    for (scheme, accuracy), said in zip(runs, told, strict=True):
        _, speed = throw_at_a_plate(scheme, SAFE_STEP_S, 0.06, accuracy)
        assert speed == pytest.approx(float(said), abs=0.05)
