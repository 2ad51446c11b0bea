"""Two spatulas lean in holders on one arm, with friction and gravity."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from plant_scenes import PlantScene
from pydrake.geometry import Cylinder, Mesh
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.tree import (
    QuaternionFloatingJoint,
    RevoluteJoint,
    RevoluteSpring,
    SpatialInertia,
    UnitInertia,
)

from drake_haptics.scene.schema import ContactParameters, Effects, FrictionParameters

MASS, SHAFT_M, LENGTH_M, P_CM_M = 0.05, 0.005, 0.16, 0.12
TOLERANCE_M = 1e-3
TICK_S = 0.02
# Of a spatula that turns at 0.1 rad/s about its shaft.
STILL_J = 1e-7
Y_M = (-0.05, 0.05)


def rest_on_an_arm(
    folder: Path, angular_damping: float, duration_s: float
) -> dict[str, np.ndarray]:
    """Returns time series, a row for each spatula.

    Args:
        folder: For the mesh of a holder.
        angular_damping: Of the spatulas' free joints, N·m·s/rad.
        duration_s: Time that is simulated, s.

    Returns:
        `spin`, about the shaft, rad/s; `yaw`, rad; `kinetic` energy, J; `support`,
        the vertical force of contact, N; `slides`, whether any contact does; `across`,
        the part of the angular velocity across the line through its two contacts,
        rad/s, or NaN where there are not two.
    """
    scene = PlantScene()
    plant = scene.plant
    arm = plant.AddRigidBody(
        "arm", SpatialInertia.SolidBoxWithMass(1.0, 0.3, 0.3, 0.05)
    )
    elbow = plant.AddJoint(
        RevoluteJoint("elbow", plant.world_frame(), arm.body_frame(), [0, 1, 0], 0.5)
    )
    plant.AddForceElement(RevoluteSpring(elbow, 0.0, 50.0))
    tube = trimesh.creation.annulus(r_min=0.012, r_max=0.018, height=0.08, sections=24)
    tube.export(folder / "tube.obj")
    square_m2 = [4e-3 + P_CM_M**2, 4.4e-3 + P_CM_M**2, 4e-4]
    for n, y in enumerate(Y_M):
        X_AH = RigidTransform([0.15, y, 0.0])
        scene.touchable(arm, Mesh(str(folder / "tube.obj")), X_AH, f"tube{n}")
        floor = RigidTransform([0.15, y, -0.0425])
        scene.touchable(arm, Cylinder(0.018, 0.005), floor, f"floor{n}")
        tool = plant.AddRigidBody(
            f"spatula{n}",
            SpatialInertia(MASS, [0.0, 0.0, P_CM_M], UnitInertia(*square_m2)),
        )
        shaft = RigidTransform([0.0, 0.0, LENGTH_M / 2.0])
        scene.touchable(tool, Cylinder(SHAFT_M, LENGTH_M), shaft, f"shaft{n}")
        plant.AddJoint(
            QuaternionFloatingJoint(
                f"free{n}", plant.world_frame(), tool.body_frame(), angular_damping, 0.0
            )
        )
    scene.finalize()
    renderings = [
        scene.render(
            f"spatula{n}",
            environment=["arm"],
            contact=ContactParameters(
                stiffness_N_per_m=2e3, damping_Ns_per_m=5.0, tolerance_m=TOLERANCE_M
            ),
            effects=Effects(friction=FrictionParameters(coefficient=0.3)),
            name=f"rendering{n}",
        )
        for n in range(2)
    ]
    scene.start()
    for n, y in enumerate(Y_M):
        lean = RollPitchYaw(0.03 * (1 - 2 * n), 0.04, 0.1 + n)
        X_WT = RigidTransform(lean, [0.15, y, TOLERANCE_M - 0.04])
        plant.GetJointByName(f"free{n}").SetPose(scene.context, X_WT)
    rows = []
    for tick in range(round(duration_s / TICK_S)):
        scene.simulator.AdvanceTo((tick + 1) * TICK_S)
        row = []
        for n, rendering in enumerate(renderings):
            name = f"spatula{n}"
            R_WT, V_WT = scene.pose(name).rotation(), scene.velocity(name)
            M_T = (
                plant.GetBodyByName(name).default_spatial_inertia().CopyToFullMatrix6()
            )
            V_T = np.concatenate([R_WT.inverse() @ V_WT[:3], R_WT.inverse() @ V_WT[3:]])
            slides = any(scene.read(rendering, "friction_force").sliding)
            support = scene.read(rendering, "F_To_W")[5]
            yaw = R_WT.ToRollPitchYaw().yaw_angle()
            p_WC = scene.read(rendering, "contacts").p_WCa
            across = np.nan
            if len(p_WC) == 2:
                line = (p_WC[1] - p_WC[0]) / np.linalg.norm(p_WC[1] - p_WC[0])
                across = np.linalg.norm(V_WT[:3] - line * (V_WT[:3] @ line))
            row.append([V_T[2], yaw, 0.5 * V_T @ M_T @ V_T, support, slides, across])
        rows.append(row)
    names = ("spin", "yaw", "kinetic", "support", "slides", "across")
    return dict(zip(names, np.array(rows).T, strict=True))


@pytest.mark.filterwarnings("ignore:Drake's own contact")
@pytest.mark.parametrize(
    ("angular_damping", "duration_s"),
    [
        (0.0, 10.0),
        # Still after 4 s.
        (1e-4, 6.0),
    ],
)
def test_two_spatulas_stand_in_their_holders(tmp_path, angular_damping, duration_s):
    """One may rock about the line through its two contacts; neither turns for ever.

    Points of contact bear no torque about the line through them, and what rolls there
    neither slides nor approaches: nothing takes energy out, but nothing adds any.
    """
    found = rest_on_an_arm(tmp_path, angular_damping, duration_s)
    third, last = np.split(found["yaw"], 4, axis=1)[2:]
    half, late = 2 * last.shape[1], 3 * last.shape[1]
    assert not found["slides"][:, half:].any()
    assert found["support"][:, half:].mean(axis=1) == pytest.approx(
        np.full(2, MASS * 9.81), rel=0.02
    )
    drift = np.radians(0.025) * duration_s
    assert last.mean(axis=1) == pytest.approx(third.mean(axis=1), abs=drift)
    assert np.ptp(last, axis=1).max() < np.radians(5.0)
    for kinetic in found["kinetic"]:
        assert kinetic[late:].max() <= max(1.2 * kinetic[half:late].max(), STILL_J)
    for spin, across in zip(found["spin"], found["across"], strict=True):
        if np.abs(spin[late:]).max() > 0.1:
            # It rocks: always on two contacts, about the line through them.
            assert np.isfinite(across[late:]).mean() > 0.95
            assert np.nanmax(across[late:]) < 0.2 * np.abs(spin[late:]).max()
    if angular_damping:
        assert np.abs(found["spin"][:, late:]).max() < 1e-2
        assert found["kinetic"][:, late:].max() < STILL_J
