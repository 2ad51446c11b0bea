"""Small plants for tests: bodies with shapes above a fixed slab, made on the spot."""

from __future__ import annotations

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Box, SceneGraph, Shape
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    CoulombFriction,
    ExternallyAppliedSpatialForce,
    MultibodyPlant,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import RigidBody, SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder, OutputPort
from pydrake.systems.primitives import ConstantValueSource

from drake_haptics import AddHapticRendering

G = 9.81
# A plant without a time step, and discrete ones with both kinds of output ports.
PLANTS = {
    "continuous": MultibodyPlantConfig(time_step=0.0),
    "sampled": MultibodyPlantConfig(time_step=1e-3, use_sampled_output_ports=True),
    "unsampled": MultibodyPlantConfig(time_step=1e-3, use_sampled_output_ports=False),
}
RUBBER = CoulombFriction(0.5, 0.5)


class PlantScene:
    """A plant that is being built; `finalize` it, render, then `start`."""

    def __init__(self, config: MultibodyPlantConfig = PLANTS["sampled"]):
        self.builder = DiagramBuilder()
        self.plant: MultibodyPlant
        self.scene_graph: SceneGraph
        self.plant, self.scene_graph = AddMultibodyPlant(config, self.builder)

    def add(
        self, name: str, *shapes: Shape, mass: float = 0.1, side: float = 0.04
    ) -> RigidBody:
        """Adds a free body with shapes at its origin and the inertia of a cube."""
        body = self.plant.AddRigidBody(
            name, SpatialInertia.SolidBoxWithMass(mass, side, side, side)
        )
        for n, shape in enumerate(shapes):
            self.touchable(body, shape, name=f"{name}{n}")
        return body

    def touchable(self, body, shape, X_BG=None, name="shape"):
        """Gives a body a shape."""
        self.plant.RegisterCollisionGeometry(
            body, X_BG or RigidTransform(), shape, name, RUBBER
        )

    def add_fixed(self, name: str, shape: Shape, X_BG=None) -> RigidBody:
        """Adds a body that is welded to the world."""
        body = self.plant.AddRigidBody(name, SpatialInertia.SolidCubeWithDensity(1, 1))
        self.touchable(body, shape, X_BG, name)
        self.plant.WeldFrames(self.plant.world_frame(), body.body_frame())
        return body

    def add_slab(self) -> RigidBody:
        """Adds a slab that is welded to the world; its top is z = 0."""
        X_BG = RigidTransform([0, 0, -0.05])
        return self.add_fixed("slab", Box(1.0, 1.0, 0.1), X_BG)

    def finalize(self, gravity: float = G) -> PlantScene:
        """Ends the plant."""
        self.plant.mutable_gravity_field().set_gravity_vector([0, 0, -gravity])
        self.plant.Finalize()
        return self

    def render(self, tool: str = "tool", **options):
        """Adds haptic rendering of a tool to the plant, which is finalized."""
        return AddHapticRendering(
            self.builder, self.plant, self.scene_graph, tool, **options
        )

    def start(self, **poses: RigidTransform) -> PlantScene:
        """Builds the diagram and places free bodies by their names."""
        self.diagram = self.builder.Build()
        self.simulator = Simulator(self.diagram)
        self.root: Context = self.simulator.get_mutable_context()
        self.context = self.plant.GetMyMutableContextFromRoot(self.root)
        for name, X_WB in poses.items():
            self.place(name, X_WB)
        return self

    def place(self, name: str, X_WB: RigidTransform) -> None:
        """Places a free body."""
        self.plant.SetFloatingBaseBodyPoseInWorldFrame(
            self.context, self.plant.GetBodyByName(name), X_WB
        )

    def pose(self, name: str) -> RigidTransform:
        """Returns the pose of a body."""
        return self.plant.EvalBodyPoseInWorld(
            self.context, self.plant.GetBodyByName(name)
        )

    def velocity(self, name: str) -> np.ndarray:
        """Returns the spatial velocity [ω; v] of a body's origin."""
        return self.plant.EvalBodySpatialVelocityInWorld(
            self.context, self.plant.GetBodyByName(name)
        ).get_coeffs()

    def read(self, system, port: str):
        """Returns an output of a system."""
        return system.GetOutputPort(port).Eval(system.GetMyContextFromRoot(self.root))


def make_push(builder: DiagramBuilder, body: RigidBody, f) -> OutputPort:
    """Returns the output of a source that pushes a body with a force f (3,), N."""
    force = ExternallyAppliedSpatialForce()
    force.body_index = body.index()
    force.F_Bq_W = SpatialForce(np.zeros(3), f)
    return builder.AddSystem(ConstantValueSource(Value([force]))).get_output_port()


def over_a_slab(
    shape: Shape,
    *names: str,
    config: MultibodyPlantConfig = PLANTS["sampled"],
    gravity: float = G,
    **inertia: float,
) -> PlantScene:
    """Returns a finalized scene of a slab and free bodies, "tool" if none is named."""
    scene = PlantScene(config)
    for name in names or ("tool",):
        scene.add(name, shape, **inertia)
    scene.add_slab()
    return scene.finalize(gravity)
