"""Simulates a device's arm, and solves its inverse kinematics."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import (
    JacobianWrtVariable,
    RigidBody,
    SpatialInertia,
    UnitInertia,
)
from pydrake.systems.framework import Diagram, DiagramBuilder

from drake_haptics.systems.arm.arm_twin import ArmTwin, add_arm_twin
from drake_haptics.systems.arm.hand_impedance import (
    HandGrip,
    HandImpedance,
    make_held_arm,
)
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.framework.vector_ports import export_parts

_MAX_ITERATIONS = 100
_LARGEST_STEP_RAD = 0.3
# rad and m: so small because stiff springs at the handle turn errors into forces.
_TOLERANCE = 1e-12
# Bound on the Jacobian with lengths in units of the arm's length: below it, some motion
# of the handle needs ten times the joint speed of the easiest one.
_ARM_LENGTH_M = 0.2
_SMALLEST_SINGULAR_VALUE = 0.1


class UnreachableError(ValueError):
    """A pose that an arm cannot take, or only at the edge of its reach."""


def solve_arm_positions(
    plant: MultibodyPlant, handle: RigidBody, X_WH: RigidTransform, q_guess: np.ndarray
) -> np.ndarray:
    """Returns joint positions that put the handle at a pose, by Newton's method.

    Args:
        plant: Finalized plant of the arm, six joints.
        handle: Body of the arm that is held.
        X_WH: Pose of the handle to reach.
        q_guess: Joint positions to start from, rad; they decide between several
            solutions.

    Raises:
        UnreachableError: There is no solution near the guess, or the arm is singular
            there.
    """
    context = plant.CreateDefaultContext()
    q = np.array(q_guess, dtype=float)
    for _ in range(_MAX_ITERATIONS):
        plant.SetPositions(context, q)
        X_WN = plant.EvalBodyPoseInWorld(context, handle)
        turn = (X_WH.rotation() @ X_WN.rotation().inverse()).ToAngleAxis()
        error = np.concatenate(
            [turn.angle() * turn.axis(), X_WH.translation() - X_WN.translation()]
        )
        J = plant.CalcJacobianSpatialVelocity(
            context,
            JacobianWrtVariable.kQDot,
            handle.body_frame(),
            np.zeros(3),
            plant.world_frame(),
            plant.world_frame(),
        )
        # Lengths in units of the arm's make the six rows comparable.
        J[3:] /= _ARM_LENGTH_M
        error[3:] /= _ARM_LENGTH_M
        if np.linalg.norm(error) < _TOLERANCE:
            if np.linalg.svd(J, compute_uv=False)[-1] < _SMALLEST_SINGULAR_VALUE:
                raise UnreachableError(
                    "the arm is at the edge of its reach or in gimbal lock"
                )
            return q
        damping = 1e-4 * min(1.0, float(np.linalg.norm(error)))
        step = np.linalg.solve(J.T @ J + damping * np.eye(len(q)), J.T @ error)
        q += step * min(1.0, _LARGEST_STEP_RAD / float(np.max(np.abs(step))))
    raise UnreachableError("the arm does not reach that far")


class SimulatedArm(Diagram):
    """A device backend: a `MultibodyPlant` arm whose handle a hand holds.

    The arm moves in continuous time: a discrete plant would hide the instability of a
    sampled loop. It starts at rest with its handle where the hand wants it. Gravity is
    off, as on a device that compensates its own weight. It renders every wrench at once
    and reports its true pose, except for the faults that an `ArmTwin` names.

    .. pydrake_system::

        name: SimulatedArm
        input_ports:
        - F_Ho_W_rendered
        output_ports:
        - X_WH
        - V_WH

    `F_Ho_W_rendered` is that of `HandImpedance`.

    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m.
    * `V_WH` (6) is its spatial velocity [ω; v] in the world, rad/s and m/s.
    """

    def __init__(
        self,
        model: Path,
        handle_link: str,
        X_WB: RigidTransform,
        path: HandPath,
        X_PH: RigidTransform,
        grip: HandGrip | None,
        twin: ArmTwin | None = None,
    ):
        """Constructs the arm.

        Args:
            model: SDF file of an arm of six revolute joints, with a link `base`.
            handle_link: Name of the link that is held.
            X_WB: Pose of the base in the world.
            path: Path along which the hand moves P.
            X_PH: Pose in P at which the hand wants the handle.
            grip: Grip of the hand; None leaves the arm free.
            twin: Faults of a real arm. Defaults to none.

        Raises:
            UnreachableError: The path starts out of the arm's reach.
            ValueError: The arm is not a chain of six revolute joints, or a value of the
                twin is out of range.
        """
        super().__init__()
        builder = DiagramBuilder()
        plant = builder.AddNamedSystem("arm", make_arm_plant(model, X_WB))
        handle = plant.GetBodyByName(handle_link)
        if grip is not None:
            weld_hand(plant, handle, grip)
        plant.Finalize()
        X_WH = path.start @ X_PH
        q_rest = np.zeros(plant.num_positions())
        plant.SetDefaultPositions(solve_arm_positions(plant, handle, X_WH, q_rest))
        hand_impedance = builder.AddNamedSystem(
            "hand_impedance",
            HandImpedance(
                plant, handle, path, X_PH, grip.make_gains() if grip else None
            ),
        )
        builder.Connect(
            plant.get_state_output_port(), hand_impedance.GetInputPort("arm_state")
        )
        wrench = hand_impedance.GetInputPort("F_Ho_W_rendered")
        force = hand_impedance.GetOutputPort("generalized_force")
        handle_state = hand_impedance.GetOutputPort("handle_state")
        if twin is not None:
            free_arm = make_held_arm(plant, handle, path, X_PH, None)
            wrench, force, handle_state = add_arm_twin(
                builder, twin, plant, hand_impedance, free_arm
            )
        builder.Connect(force, plant.get_applied_generalized_force_input_port())
        builder.ExportInput(wrench, "F_Ho_W_rendered")
        export_parts(builder, handle_state, {"X_WH": 7, "V_WH": 6})
        builder.BuildInto(self)


def weld_hand(plant: MultibodyPlant, handle: RigidBody, grip: HandGrip) -> None:
    """Adds the mass of a hand to a handle.

    Args:
        plant: Plant of the arm, not finalized.
        handle: Body of the arm that is held.
        grip: Grip of the hand.
    """
    hand = plant.AddRigidBody(
        "hand",
        handle.model_instance(),
        SpatialInertia(
            grip.mass_kg,
            np.zeros(3),
            UnitInertia(*[grip.inertia_kgm2 / grip.mass_kg] * 3),
        ),
    )
    plant.WeldFrames(handle.body_frame(), hand.body_frame())


def make_arm_plant(model: Path, X_WB: RigidTransform) -> MultibodyPlant:
    """Returns an arm, not finalized, continuous, without gravity.

    Args:
        model: SDF file with a link `base`.
        X_WB: Pose of that link in the world.
    """
    plant = MultibodyPlant(0.0)
    # Drake takes 25 ms longer to read the same model from a file.
    Parser(plant).AddModelsFromString(
        model.read_text(encoding="utf-8"), model.suffix.removeprefix(".")
    )
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"), X_WB)
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    return plant
