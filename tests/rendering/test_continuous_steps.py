"""Integrators of a continuous plant step no further than the rendering's period."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from plant_scenes import PLANTS, G, PlantScene, over_a_slab
from pydrake.geometry import Box
from pydrake.math import RigidTransform
from pydrake.systems.analysis import (
    ApplySimulatorConfig,
    GetIntegrationSchemes,
    SimulatorConfig,
)

from drake_haptics.scene.schema import ContactParameters

TOLERANCE_M = 2e-3
SPEED_M_PER_S = 1.0
SAFE_STEP_S = TOLERANCE_M / SPEED_M_PER_S
HALF_CUBE_M = 0.01
SCHEMES = ["runge_kutta3"] + [s for s in ("cenic",) if s in GetIntegrationSchemes()]


def throw_at_a_plate(
    scheme: str, period_s: float | None, height_m: float = 0.06, accuracy: float = 1e-3
) -> tuple[float, float]:
    """Returns height (m) and speed (m/s) at the end of a cube thrown at a plate.

    The plate's top is z = 0, and it is 10 mm thick.

    Args:
        scheme: Of the integrator, with error control.
        period_s: Of the rendering; None for the default.
        height_m: Of the cube's middle when it starts.
        accuracy: Of the error control.
    """
    scene = PlantScene(PLANTS["continuous"])
    scene.add_fixed("plate", Box(0.2, 0.2, 0.01), RigidTransform([0, 0, -0.005]))
    side = 2.0 * HALF_CUBE_M
    scene.add("cube", Box(side, side, side), side=side)
    scene.finalize(gravity=0.0)
    rendering = scene.render(
        "cube",
        contact=ContactParameters(stiffness_N_per_m=2e4, tolerance_m=TOLERANCE_M),
        period_s=period_s,
    )
    asked_s = TOLERANCE_M / rendering.skin_speed_m_per_s
    assert asked_s == pytest.approx(period_s or 1e-3)
    scene.start(cube=RigidTransform([0.0, 0.0, height_m]))
    scene.plant.SetVelocities(scene.context, [0.0, 0.0, 0.0, 0.0, 0.0, -SPEED_M_PER_S])
    config = SimulatorConfig(
        integration_scheme=scheme, accuracy=accuracy, use_error_control=True
    )
    ApplySimulatorConfig(config, scene.simulator)
    scene.simulator.AdvanceTo(0.2)
    integrator = scene.simulator.get_integrator()
    assert integrator.get_largest_step_size_taken() <= asked_s * (1.0 + 1e-9)
    return float(scene.pose("cube").translation()[2]), float(scene.velocity("cube")[5])


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.75])
def test_a_step_of_tolerance_over_speed_meets_the_plate(scheme, share):
    """Wherever in a step the cube comes to the tolerance; it comes back out."""
    height_m = 0.06 + share * SAFE_STEP_S * SPEED_M_PER_S
    end_m, _ = throw_at_a_plate(scheme, SAFE_STEP_S, height_m)
    assert end_m > HALF_CUBE_M + TOLERANCE_M


@pytest.mark.parametrize("scheme", SCHEMES)
def test_without_a_period_every_step_is_safe_below_the_skin_speed(scheme):
    """The default of 1 ms; no accuracy asks for what no step has met."""
    end_m, _ = throw_at_a_plate(scheme, None)
    assert end_m > HALF_CUBE_M + TOLERANCE_M


needs_cenic = pytest.mark.skipif(
    "cenic" not in SCHEMES, reason="this Drake has no CENIC"
)


@needs_cenic
@pytest.mark.filterwarnings("ignore:a contact is")
def test_a_period_that_is_far_too_long_goes_through_the_plate():
    """As docs/compose.md warns."""
    end_m, _ = throw_at_a_plate("cenic", 0.1, height_m=0.08)
    assert end_m < -0.01 - HALF_CUBE_M - TOLERANCE_M


@needs_cenic
@pytest.mark.parametrize("stiffness_N_per_m", [4e5, 4e7])
def test_cenic_holds_a_cube_in_steps_far_above_the_explicit_bound(stiffness_N_per_m):
    """By 2 √(m/K), 1 ms and 0.1 ms; it comes to rest where its weight is borne."""
    mass, period_s, side = 0.1, 1e-2, 2.0 * HALF_CUBE_M
    cube = Box(side, side, side)
    scene = over_a_slab(cube, "cube", config=PLANTS["continuous"], mass=mass, side=side)
    scene.render(
        "cube",
        contact=ContactParameters(
            stiffness_N_per_m=stiffness_N_per_m,
            damping_Ns_per_m=20.0,
            tolerance_m=TOLERANCE_M,
        ),
        period_s=period_s,
    )
    rest_m = HALF_CUBE_M + TOLERANCE_M - mass * G / stiffness_N_per_m
    scene.start(cube=RigidTransform([0.0, 0.0, rest_m + 1e-3]))
    config = SimulatorConfig(
        integration_scheme="cenic", accuracy=1e-3, use_error_control=True
    )
    ApplySimulatorConfig(config, scene.simulator)
    scene.simulator.AdvanceTo(0.3)
    integrator = scene.simulator.get_integrator()
    before = integrator.get_num_steps_taken()
    scene.simulator.AdvanceTo(0.5)
    step_s = 0.2 / (integrator.get_num_steps_taken() - before)
    assert step_s == pytest.approx(period_s)
    assert step_s > 5.0 * 2.0 * math.sqrt(mass / stiffness_N_per_m)
    assert scene.pose("cube").translation()[2] == pytest.approx(rest_m, abs=1e-8)


@needs_cenic
def test_the_page_tells_how_fast_the_cube_comes_back():
    page = (Path(__file__).parents[2] / "docs" / "compose.md").read_text("utf-8")
    told = re.findall(r"([\d.]+) m/s", page.split("the flying cube comes back")[1])[:3]
    runs = [("cenic", 1e-3), ("runge_kutta3", 1e-3), ("cenic", 1e-6)]
    for (scheme, accuracy), said in zip(runs, told, strict=True):
        _, speed = throw_at_a_plate(scheme, None, accuracy=accuracy)
        assert speed == pytest.approx(float(said), abs=0.05)
