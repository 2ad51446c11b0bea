"""Runs the loop of `AddHapticRendering` in a discrete plant."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import InMemoryMesh, Mesh, ProximityProperties
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    MultibodyPlant,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import RigidBody, RotationalInertia, SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, Diagram, DiagramBuilder

from drake_haptics.evaluation.benchmark.loop.problem import (
    LoopCourse,
    LoopProblem,
    moments_and_products,
)
from drake_haptics.evaluation.benchmark.loop.simulated_ticks import time_ticks
from drake_haptics.evaluation.benchmark.loop.this_package import make_recorded_device
from drake_haptics.evaluation.measuring.pieces import quiet_streams
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.rendering.add_haptic_rendering import AddHapticRendering
from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.scene.validation import SceneWarning


class PlantLoop:
    """The tool is a free body of a discrete `MultibodyPlant`; the objects are welded.

    The handle is that of a `HapticDevice` which moves as recorded. A discrete plant
    takes applied forces at the beginning of its step, so that the rotational damping
    of the coupling is bounded as in `StockLoop`.
    """

    def __init__(self, problem: LoopProblem, *, paced: bool = False):
        """Builds the diagram.

        Args:
            problem: What it is given.
            paced: Whether ticks that are timed wait for the clock.
        """
        self._problem = problem
        self._paced = paced
        builder = DiagramBuilder()
        with quiet_streams(2):
            self._plant, scene_graph = AddMultibodyPlant(
                MultibodyPlantConfig(time_step=problem.motion.period_s), builder
            )
            self._plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
            tool = _add_tool(self._plant, problem)
            _add_objects(self._plant, problem)
            self._plant.Finalize()
        with warnings.catch_warnings():
            # Of an explicit step that may not hold the rotation of the coupling.
            warnings.simplefilter("ignore", SceneWarning)
            self._rendering = AddHapticRendering(
                builder,
                self._plant,
                scene_graph,
                tool,
                contact=problem.scene.contact,
                coupling=_bound_damping(problem),
                device=make_recorded_device(problem),
                X_HT=problem.X_HT,
            )
        self._diagram = builder.Build()

    @property
    def diagram(self) -> Diagram:
        """The diagram that is run."""
        return self._diagram

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        simulator = self.make_simulator()
        root = simulator.get_context()
        plant = self._plant.GetMyContextFromRoot(root)
        port = self._rendering.GetOutputPort("contacts")
        rendering = self._rendering.GetMyContextFromRoot(root)
        poses: list[np.ndarray] = []
        contacts: list[tuple[int, float]] = []

        def note(context: Context) -> None:
            poses.append(self._plant.GetPositions(plant))
            found = port.Eval(rendering)
            contacts.append((len(found), min(found.distance.tolist(), default=0.0)))

        note(root)
        n = len(self._problem.motion)
        simulator.Initialize()
        simulator.set_monitor(note)
        simulator.AdvanceTo((n - 0.5) * self._problem.motion.period_s)
        X_WT, (count, nearest_m) = np.array(poses[:n]), np.array(contacts[:n]).T
        force_N = self._problem.spring_force(X_WT[:, 4:])
        return LoopCourse(X_WT, count.astype(int), nearest_m, force_N)

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        motion = self._problem.motion
        return time_ticks(
            self.make_simulator(), len(motion), motion.period_s, paced=self._paced
        )

    def make_simulator(self) -> Simulator:
        """Returns a simulator at the beginning of the motion."""
        simulator = Simulator(self._diagram)
        context = self._plant.GetMyMutableContextFromRoot(
            simulator.get_mutable_context()
        )
        self._plant.SetPositions(context, self._problem.X_WG[0])
        return simulator


def _add_tool(plant: MultibodyPlant, problem: LoopProblem) -> RigidBody:
    p_TTcm, I_T = problem.mass_properties()
    tool = plant.AddRigidBody(
        "tool",
        SpatialInertia.MakeFromCentralInertia(
            problem.scene.tool.mass_kg,
            p_TTcm,
            RotationalInertia(*moments_and_products(I_T)),
        ),
    )
    _add_shape(plant, tool, problem.tool)
    return tool


def _add_objects(plant: MultibodyPlant, problem: LoopProblem) -> None:
    items = zip(problem.scene.environment, problem.objects, problem.X_WO, strict=True)
    for item, part, X_WO in items:
        body = plant.AddRigidBody(
            item.name, SpatialInertia.SolidSphereWithMass(1.0, 1.0)
        )
        plant.WeldFrames(plant.world_frame(), body.body_frame(), X_WO)
        _add_shape(plant, body, part)


def _add_shape(
    plant: MultibodyPlant, body: RigidBody, decomposition: Decomposition
) -> None:
    """Gives a body the mesh that the pieces are of."""
    mesh = decomposition.mesh
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in mesh.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.triangles + 1).tolist()]
    file = MemoryFile("\n".join(lines) + "\n", ".obj", f"{body.name()}.obj")
    plant.RegisterCollisionGeometry(
        body,
        RigidTransform(),
        Mesh(InMemoryMesh(mesh_file=file)),
        body.name(),
        ProximityProperties(),
    )


def _bound_damping(problem: LoopProblem) -> CouplingParameters:
    """Returns the scene's coupling with a damping that an explicit step holds."""
    coupling = problem.scene.coupling
    inertia = float(np.linalg.eigvalsh(problem.mass_properties()[1]).min())
    return replace(
        coupling,
        rotational_damping_Nms_per_rad=min(
            coupling.rotational_damping_Nms_per_rad,
            inertia / problem.motion.period_s,
        ),
    )
