"""A free block on a slope rests below the angle of friction and slides above it."""

import numpy as np
import pytest
from plant_scenes import G, PlantScene
from pydrake.geometry import Box
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics import ContactParameters, Effects, FrictionParameters

SIDE_M, MASS_KG = 0.04, 0.2
FRICTION = 0.5  # its angle is 26.6°


def travel(slope_deg: float, stiffness: float, times_s: list[float]) -> np.ndarray:
    """Returns how far a block has come down a slope, m, where it begins at rest."""
    angle = np.deg2rad(slope_deg)
    R_WS = RotationMatrix.MakeYRotation(angle)
    scene = PlantScene()
    scene.add("tool", Box(SIDE_M, SIDE_M, SIDE_M), mass=MASS_KG, side=SIDE_M)
    X_WS = RigidTransform(R_WS, R_WS.col(2) * -0.01)
    scene.add_fixed("slope", Box(6.0, 1.0, 0.02), X_WS)
    scene.finalize()
    contact = ContactParameters(stiffness_N_per_m=stiffness, damping_Ns_per_m=30.0)
    friction = FrictionParameters(coefficient=FRICTION)
    scene.render(contact=contact, effects=Effects(friction=friction))
    carried_m = contact.tolerance_m - MASS_KG * G * np.cos(angle) / stiffness
    p_WB = R_WS.col(2) * (SIDE_M / 2 + carried_m)
    scene.start(tool=RigidTransform(R_WS, p_WB))
    down = []
    for time in times_s:
        scene.simulator.AdvanceTo(time)
        down.append(R_WS.col(0) @ scene.pose("tool").translation())
    return np.array(down)


@pytest.mark.parametrize("slope_deg", [10.0, 20.0, 24.0])
def test_it_rests_below_the_angle_of_friction(slope_deg):
    """Stiffer contact than this lets it rock and creep: docs/compose.md."""
    down = travel(slope_deg, 5e3, [1.0, 1.5])
    assert down[0] < 2e-3
    assert abs(down[1] - down[0]) < 2e-5


def test_it_slides_above_it():
    first, second = travel(30.0, 5e3, [0.5, 1.0])
    assert second - first > 0.05
