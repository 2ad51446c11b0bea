"""Runs a loop of Drake's own parts: a bushing, and point contact on pieces."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    DiscreteContactApproximation,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    LinearBushingRollPitchYaw,
    SpatialInertia,
)
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder

from drake_haptics.evaluation.benchmark.loop.problem import LoopCourse, LoopProblem
from drake_haptics.evaluation.benchmark.loop.simulated_ticks import time_ticks
from drake_haptics.evaluation.measuring.pieces import (
    make_surface,
    quiet_streams,
    register_pieces,
)

# Heavy enough that the bushing hardly moves the handle in a tick: 1 µm/s at 1 kN.
_HANDLE_KG = 1e6
_HANDLE_RADIUS_M = 1.0


def has_solver(solver: str) -> bool:
    """Returns whether this Drake has a contact solver; newer ones lack "tamsi"."""
    return hasattr(DiscreteContactApproximation, f"k{solver.capitalize()}")


class StockLoop:
    """A discrete `MultibodyPlant`: a bushing, and point contact.

    The handle is a heavy free body whose position and velocity are set between ticks,
    which is not timed: a `TrajectorySource` on joints with PD control would need SAP,
    the slower solver, and six more joints. The bushing has the scene's gains except for
    the rotational damping: Drake computes a bushing's forces at the beginning of the
    step, which diverges from 2 I / h on.
    """

    def __init__(self, problem: LoopProblem, solver: str, *, paced: bool = False):
        self._problem = problem
        self._paced = paced
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(
            time_step=problem.motion.period_s,
            contact_model="point",
            discrete_contact_approximation=solver,
        )
        # Drake warns that TAMSI will be removed, and Qhull that pieces are flat.
        with quiet_streams(2):
            self._plant, _ = AddMultibodyPlant(config, builder)
            self._plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
            self._add_bodies()
            self._plant.Finalize()
            self._diagram = builder.Build()

    def observe(self) -> LoopCourse:
        """See `Loop.observe`."""
        plant, problem = self._plant, self._problem
        results = plant.get_contact_results_output_port()
        poses: list[np.ndarray] = []
        contacts: list[tuple[int, float]] = []

        def note(context: Context) -> None:
            poses.append(plant.GetPositions(context)[7:])
            found = results.Eval(context)
            depths = [
                found.point_pair_contact_info(i).point_pair().depth
                for i in range(found.num_point_pair_contacts())
            ]
            contacts.append((len(depths), -max(depths, default=0.0)))

        self._run(note, paced=False)
        X_WT, (count, nearest_m) = np.array(poses), np.array(contacts).T
        force_N = problem.spring_force(X_WT[:, 4:])
        return LoopCourse(X_WT, count.astype(int), nearest_m, force_N)

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        return self._run(lambda context: None, paced=self._paced)

    def _run(self, note: Callable[[Context], None], *, paced: bool) -> np.ndarray:
        """Calls `note` before each tick; returns the time (n,) of each tick, s."""
        plant, motion = self._plant, self._problem.motion
        simulator = Simulator(self._diagram)
        context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        state = np.concatenate([motion.X_WH[0], self._problem.X_WG[0], np.zeros(12)])
        # All positions, then all velocities.
        handle_rows = np.r_[0:7, 14:20]
        handle = np.hstack([motion.X_WH, motion.V_WH])
        state[handle_rows] = handle[0]
        plant.SetPositionsAndVelocities(context, state)
        note(context)
        n = len(motion)

        def move_handle(tick: int) -> None:
            if tick < n:
                state = plant.GetPositionsAndVelocities(context)
                state[handle_rows] = handle[tick]
                plant.SetPositionsAndVelocities(context, state)
                note(context)

        return time_ticks(
            simulator, n, motion.period_s, paced=paced, between=move_handle
        )

    def _add_bodies(self) -> None:
        problem, plant = self._problem, self._plant
        handle = plant.AddRigidBody(
            "handle", SpatialInertia.SolidSphereWithMass(_HANDLE_KG, _HANDLE_RADIUS_M)
        )
        tool = plant.AddRigidBody("tool", problem.M_TTo_T)
        contact = problem.scene.contact
        surface = make_surface(contact.stiffness_N_per_m, contact.damping_Ns_per_m)
        register_pieces(plant, tool, RigidTransform(), problem.tool, surface)
        for part, X_WO in zip(problem.objects, problem.X_WO, strict=True):
            register_pieces(plant, plant.world_body(), X_WO, part, surface)
        grip = plant.AddFrame(
            FixedOffsetFrame("grip", handle.body_frame(), problem.X_HT)
        )
        gains = problem.scene.coupling
        plant.AddForceElement(
            LinearBushingRollPitchYaw(
                grip,
                tool.body_frame(),
                [gains.rotational_stiffness_Nm_per_rad] * 3,
                [problem.explicit_rotational_damping] * 3,
                [gains.stiffness_N_per_m] * 3,
                [gains.damping_Ns_per_m] * 3,
            )
        )
