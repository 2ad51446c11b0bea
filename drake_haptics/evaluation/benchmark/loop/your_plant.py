"""Runs the loop of `AddHapticRendering` in a discrete plant."""

from __future__ import annotations

import warnings
from dataclasses import replace

from pydrake.geometry import ProximityProperties
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlant, MultibodyPlantConfig
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.evaluation.benchmark.loop.problem import LoopCourse, LoopProblem
from drake_haptics.evaluation.benchmark.loop.simulated_ticks import (
    SimulatedLoop,
    observe_ticks,
)
from drake_haptics.evaluation.benchmark.loop.this_package import make_recorded_device
from drake_haptics.evaluation.measuring.pieces import quiet_streams, register_mesh
from drake_haptics.rendering.add_haptic_rendering import AddHapticRendering
from drake_haptics.scene.validation import SceneWarning


class PlantLoop(SimulatedLoop):
    """The tool is a free body of a discrete `MultibodyPlant`; the objects are welded.

    The handle is that of a `HapticDevice` that moves as recorded. A discrete plant
    computes applied forces at the beginning of its step, so that the rotational damping
    of the coupling is limited as in `StockLoop`.
    """

    def __init__(self, problem: LoopProblem, *, paced: bool = False):
        super().__init__(problem, paced=paced)
        builder = DiagramBuilder()
        with quiet_streams(2):
            self._plant, scene_graph = AddMultibodyPlant(
                MultibodyPlantConfig(time_step=problem.motion.period_s), builder
            )
            self._plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
            tool = self._plant.AddRigidBody("tool", problem.M_TTo_T)
            surface = ProximityProperties()
            register_mesh(self._plant, tool, RigidTransform(), problem.tool, surface)
            for item, part, X_WO in zip(
                problem.scene.environment, problem.objects, problem.X_WO, strict=True
            ):
                body = self._plant.AddRigidBody(
                    item.name, SpatialInertia.SolidSphereWithMass(1.0, 1.0)
                )
                world = self._plant.world_frame()
                self._plant.WeldFrames(world, body.body_frame(), X_WO)
                register_mesh(self._plant, body, RigidTransform(), part, surface)
            self._plant.Finalize()
        with warnings.catch_warnings():
            # It warns that the explicit step may be unstable for the coupling's
            # rotation.
            warnings.simplefilter("ignore", SceneWarning)
            self._rendering = AddHapticRendering(
                builder,
                self._plant,
                scene_graph,
                tool,
                contact=problem.scene.contact,
                coupling=replace(
                    problem.scene.coupling,
                    rotational_damping_Nms_per_rad=problem.explicit_rotational_damping,
                ),
                device=make_recorded_device(problem),
                X_HT=problem.X_HT,
            )
        self._diagram = builder.Build()

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        return observe_ticks(
            self._problem,
            self.make_simulator(),
            self._plant.get_state_output_port(),
            self._rendering.GetOutputPort("contacts"),
        )

    def make_simulator(self) -> Simulator:
        """Returns a simulator at the beginning of the motion."""
        simulator = Simulator(self._diagram)
        context = self._plant.GetMyMutableContextFromRoot(
            simulator.get_mutable_context()
        )
        self._plant.SetPositions(context, self._problem.X_WG[0])
        return simulator
