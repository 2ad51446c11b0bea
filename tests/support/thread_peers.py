"""The bolt of threads.py, turned through its nut in MuJoCo and in Drake's own plant.

MuJoCo takes both as distance fields of their meshes, Drake the bolt as a rigid surface
and the nut as a compliant mesh of tetrahedra (hydroelastic contact). There is neither
friction nor gravity. The coupling of handle and bolt is the package's, at its defaults.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import trimesh
from degenerate_scenes import MASS_KG
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Mesh,
    ProximityProperties,
)
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    ContactModel,
    CoulombFriction,
    ExternallyAppliedSpatialForce,
)
from pydrake.multibody.tree import RotationalInertia, SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from scipy.spatial.transform import Rotation
from threads import PITCH_M, PLAY_M, TURNER_WAIT_S, make_bolt, make_thread

from drake_haptics.scene.schema import CouplingParameters

# Step of both: the coupling, applied as a force of the last one, is stable with it.
STEP_S = 5e-4
_OUTER_M = 12e-3
_HOME_M = np.array([0.0, 0.0, -PITCH_M])
_MODULUS_PA, _DISSIPATION_S_PER_M = 1e8, 1e-3


@dataclass(frozen=True)
class Turning:
    """The motion of a bolt, step by step.

    Attributes:
        turns: (n,) turns of the bolt.
        z_m: (n,) height of the bolt, m.
        F_Bo_W: (n, 6) wrench of the coupling on the bolt at its frame, N·m and N.
        step_s: Median time that a step of 1 ms took, s.
    """

    turns: np.ndarray
    z_m: np.ndarray
    F_Bo_W: np.ndarray
    step_s: float


def make_nut_volume(turns: int) -> tuple[np.ndarray, np.ndarray]:
    """A nut as vertices (n, 3), m, and tetrahedra (m, 4): thread inside, round outside.

    Two layers of prisms go from the thread to the cylinder, so that vertices within
    have a pressure. Prisms are cut along the diagonals from their lowest vertices,
    which neighbors share.
    """
    inner, triangles = make_thread(turns, PLAY_M)
    outer = inner.copy()
    outer[:, :2] *= _OUTER_M / np.linalg.norm(inner[:, :2], axis=1, keepdims=True)
    vertices = np.vstack([inner, (inner + outer) / 2, outer])
    a, b, c = np.sort(triangles, axis=1).T
    cuts = []
    for low in (0, len(inner)):
        high = low + len(inner)
        cuts += [
            np.column_stack([low + a, low + b, low + c, high + c]),
            np.column_stack([low + a, low + b, high + b, high + c]),
            np.column_stack([low + a, high + a, high + b, high + c]),
        ]
    cells = np.vstack(cuts)
    edges = vertices[cells[:, 1:]] - vertices[cells[:, :1]]
    inverted = np.linalg.det(edges) < 0
    cells[inverted] = cells[inverted][:, [0, 1, 3, 2]]
    return vertices, cells


def find_boundary(vertices: np.ndarray, cells: np.ndarray) -> trimesh.Trimesh:
    """The surface of tetrahedra (m, 4): the faces that only one of them has."""
    faces = cells[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]].reshape(-1, 3)
    keys = [tuple(face) for face in np.sort(faces, axis=1)]
    count = Counter(keys)
    outside = [count[key] == 1 for key in keys]
    return trimesh.Trimesh(vertices, faces[outside])


def _couple(
    time_s: float, lead: Callable[[float], tuple[float, float]], state: tuple
) -> np.ndarray:
    """The wrench (6,) on the bolt at its frame, N·m and N, of a handle that turns."""
    gains = CouplingParameters()
    angle, w = lead(time_s)
    R_WB, p_WB, w_WB, v_WB = state
    turned = (Rotation.from_rotvec([0, 0, angle]) * R_WB.inv()).as_rotvec()
    return np.concatenate(
        [
            gains.rotational_stiffness_Nm_per_rad * turned
            + gains.rotational_damping_Nms_per_rad * (np.array([0, 0, w]) - w_WB),
            gains.stiffness_N_per_m * (_HOME_M - p_WB) - gains.damping_Ns_per_m * v_WB,
        ]
    )


def _turn(
    turns: float, turns_per_s: float, look: Callable, step: Callable, duration_s: float
) -> Turning:
    """Steps a simulation whose state `look` returns and `step` advances by a wrench."""

    def lead(time_s: float) -> tuple[float, float]:
        since_s = max(0.0, time_s - TURNER_WAIT_S)
        moves = 0 < since_s < turns / turns_per_s
        angle = 2 * np.pi * min(turns, turns_per_s * since_s)
        return angle, 2 * np.pi * turns_per_s * moves

    rows, took_s = [], []
    for k in range(round(duration_s / STEP_S)):
        state = look()
        wrench = _couple(k * STEP_S, lead, state)
        rows.append((state[0].as_rotvec()[2], state[1][2], *wrench))
        start_s = time.perf_counter()
        step(wrench)
        took_s.append(time.perf_counter() - start_s)
    angle, z, *wrenches = np.array(rows).T
    return Turning(
        np.unwrap(angle) / (2 * np.pi),
        z,
        np.array(wrenches).T,
        float(np.median(took_s)) * 1e-3 / STEP_S,
    )


def turn_in_mujoco(
    turns: float, turns_per_s: float, duration_s: float, folder: Path
) -> Turning:
    """Turns the bolt in MuJoCo, as `turn_bolt` does."""
    make_bolt(5).export(folder / "bolt.obj")
    find_boundary(*make_nut_volume(2)).export(folder / "nut.obj")
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option gravity="0 0 0" timestep="{STEP_S}"/>
      <default><geom type="sdf" condim="1"/></default>
      <asset>
        <mesh name="bolt" file="{folder}/bolt.obj"/>
        <mesh name="nut" file="{folder}/nut.obj"/>
      </asset>
      <worldbody>
        <geom mesh="nut"/>
        <body name="bolt" pos="0 0 {_HOME_M[2]}">
          <freejoint/><geom mesh="bolt" mass="{MASS_KG}"/>
        </body>
      </worldbody>
    </mujoco>""")
    data = mujoco.MjData(model)
    bolt = model.body("bolt").id

    def look() -> tuple:
        R_WB = Rotation.from_quat(data.qpos[[4, 5, 6, 3]])
        return R_WB, data.qpos[:3].copy(), R_WB.apply(data.qvel[3:]), data.qvel[:3]

    def step(wrench: np.ndarray) -> None:
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        from_center = data.qpos[:3] - data.xipos[bolt]
        torque = wrench[:3] + np.cross(from_center, wrench[3:])
        data.xfrc_applied[bolt] = np.concatenate([wrench[3:], torque])
        mujoco.mj_step(model, data)

    return _turn(turns, turns_per_s, look, step, duration_s)


def _write_vtk(path: Path, vertices: np.ndarray, cells: np.ndarray) -> str:
    """Writes tetrahedra as Drake reads them; returns the file's name."""
    lines = [
        "# vtk DataFile Version 3.0\nnut\nASCII\nDATASET UNSTRUCTURED_GRID",
        f"POINTS {len(vertices)} double",
        *(" ".join(map(repr, row)) for row in vertices.tolist()),
        f"CELLS {len(cells)} {5 * len(cells)}",
        *("4 " + " ".join(map(str, row)) for row in cells.tolist()),
        f"CELL_TYPES {len(cells)}",
        *["10"] * len(cells),
    ]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def turn_in_drake(
    turns: float, turns_per_s: float, duration_s: float, folder: Path
) -> Turning:
    """Turns the bolt in a plant with hydroelastic contact, as `turn_bolt` does."""
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=STEP_S)
    plant.set_contact_model(ContactModel.kHydroelastic)
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    mesh = make_bolt(5)
    mesh.export(folder / "bolt.obj")
    mesh.density = MASS_KG / mesh.volume
    moments = mesh.moment_inertia
    inertia = RotationalInertia(*np.diag(moments), *moments[np.triu_indices(3, 1)])
    bolt = plant.AddRigidBody(
        "bolt",
        SpatialInertia.MakeFromCentralInertia(MASS_KG, mesh.center_mass, inertia),
    )
    rigid, compliant = ProximityProperties(), ProximityProperties()
    AddRigidHydroelasticProperties(rigid)
    AddCompliantHydroelasticProperties(1e-3, _MODULUS_PA, compliant)
    for properties in (rigid, compliant):
        AddContactMaterial(
            _DISSIPATION_S_PER_M, None, CoulombFriction(0, 0), properties
        )
    nut = _write_vtk(folder / "nut.vtk", *make_nut_volume(2))
    for body, name, properties in (
        (bolt, str(folder / "bolt.obj"), rigid),
        (plant.world_body(), nut, compliant),
    ):
        plant.RegisterCollisionGeometry(
            body, RigidTransform(), Mesh(name), body.name(), properties
        )
    plant.Finalize()
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, bolt, RigidTransform(_HOME_M))
    port = plant.get_applied_spatial_force_input_port()

    def look() -> tuple:
        X_WB = bolt.EvalPoseInWorld(context)
        V_WB = bolt.EvalSpatialVelocityInWorld(context)
        R_WB = Rotation.from_matrix(X_WB.rotation().matrix())
        return R_WB, X_WB.translation(), V_WB.rotational(), V_WB.translational()

    def step(wrench: np.ndarray) -> None:
        force = ExternallyAppliedSpatialForce()
        force.body_index = bolt.index()
        force.F_Bq_W = SpatialForce(wrench[:3], wrench[3:])
        port.FixValue(context, [force])
        simulator.AdvanceTo(simulator.get_context().get_time() + STEP_S)

    return _turn(turns, turns_per_s, look, step, duration_s)
