"""A tool that is put where it was, among objects, in a `MultibodyPlant`."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydrake.geometry import SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    MultibodyPlant,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import RigidBody, SpatialInertia
from pydrake.systems.framework import Context, DiagramBuilder, OutputPort

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.peers.problem import PASSES
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.measuring.pieces import quiet_stderr
from drake_haptics.evaluation.measuring.timing import typical

AddGeometry = Callable[[MultibodyPlant, RigidBody, int, RigidTransform], None]

# Of a tool whose motion is given; they change nothing.
_MASS_KG, _RADIUS_M = 0.1, 0.1


@dataclass(frozen=True)
class DrakePlant:
    """A continuous plant, whose contacts are a function of pose and velocity alone.

    Attributes:
        plant: Finalized.
        scene_graph: With its geometry.
        tool: Of the plant.
        root: A context of the diagram.
    """

    plant: MultibodyPlant
    scene_graph: SceneGraph
    tool: RigidBody
    root: Context

    def ask(
        self,
        motion: RecordedMotion,
        port: OutputPort,
        ask: Callable[[Any], Any],
        read: Callable[[int, Any], None],
    ) -> np.ndarray:
        """Moves the tool as recorded and asks at each tick.

        Args:
            motion: Of the tool.
            port: Evaluated at each tick.
            ask: Called with the port's value.
            read: Called with the tick and the answer, once for each.

        Returns:
            (n,) what evaluating and asking took, poses brought up to date included, s.
        """
        context = self.plant.GetMyMutableContextFromRoot(self.root)
        of_port = port.get_system().GetMyContextFromRoot(self.root)
        states = np.hstack([motion.X_WTool, motion.V_WTool])
        seconds = np.zeros((PASSES, len(motion)))
        for i, one_pass in enumerate(seconds):
            for k, state in enumerate(states):
                self.plant.SetPositionsAndVelocities(context, state)
                start = time.perf_counter()
                answer = ask(port.Eval(of_port))
                one_pass[k] = time.perf_counter() - start
                if i == 0:
                    read(k, answer)
        return typical(seconds)


def make_plant(
    contact_model: str,
    X_WO: np.ndarray,
    add: AddGeometry,
) -> DrakePlant:
    """Builds a plant with a tool and objects.

    Args:
        contact_model: As `MultibodyPlantConfig` has it.
        X_WO: (m, 7) poses of the objects.
        add: Gives a body its geometry: called with the plant, the body, the object's
            index or -1 for the tool, and where the geometry is in the body's frame.
    """
    # Qhull tells of flat pieces.
    with quiet_stderr():
        return _build(contact_model, X_WO, add)


def _build(contact_model: str, X_WO: np.ndarray, add: AddGeometry) -> DrakePlant:
    builder = DiagramBuilder()
    config = MultibodyPlantConfig(time_step=0.0, contact_model=contact_model)
    plant, scene_graph = AddMultibodyPlant(config, builder)
    inertia = SpatialInertia.SolidSphereWithMass(_MASS_KG, _RADIUS_M)
    tool = plant.AddRigidBody("tool", inertia)
    add(plant, tool, -1, RigidTransform())
    for i, pose in enumerate(X_WO):
        add(plant, plant.world_body(), i, vector_to_pose(pose))
    plant.Finalize()
    diagram = builder.Build()
    return DrakePlant(plant, scene_graph, tool, diagram.CreateDefaultContext())
