"""A simulated haptic arm, held by a simulated hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import RigidBody, SpatialInertia, UnitInertia
from pydrake.systems.framework import Diagram, DiagramBuilder

from drake_haptics.systems.arm.arm_inverse_kinematics import solve_arm_positions
from drake_haptics.systems.arm.arm_twin import ArmTwin, add_arm_twin
from drake_haptics.systems.arm.hand_grip import HandGrip
from drake_haptics.systems.arm.hand_impedance import HandImpedance, make_held_arm
from drake_haptics.systems.arm.hand_path import HandPath
from drake_haptics.systems.framework.vector_ports import export_parts


class SimulatedArm(Diagram):
    """A device backend: a `MultibodyPlant` arm whose handle a hand holds.

    The arm moves in continuous time: a discrete plant would hide the instability of
    a sampled loop. It starts at rest with its handle where the hand wants it.
    Gravity is off, as on a device that compensates its own weight. It shows every
    wrench at once and tells its true pose, but for what an `ArmTwin` names.

    .. pydrake_system::

        name: SimulatedArm
        input_ports:
        - F_applied
        output_ports:
        - X_WH
        - V_WH

    `F_applied` is that of `HandImpedance`.

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
            model: SDF of an arm of six revolute joints with the links `base` and:
            handle_link: the one that is held.
            X_WB: Where the base stands.
            path: Where the hand wants P to go.
            X_PH: Where it wants the handle in P.
            grip: How it holds; None leaves the arm free.
            twin: What it has of a real arm's faults; none if not given.

        Raises:
            UnreachableError: The path starts out of the arm's reach.
            ValueError: The arm is no chain of six revolute joints, or a figure of the
                twin is out of its range.
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
            plant.get_state_output_port(), hand_impedance.get_arm_state_input_port()
        )
        wrench = hand_impedance.get_applied_wrench_input_port()
        force = hand_impedance.get_generalized_force_output_port()
        handle_state = hand_impedance.get_handle_state_output_port()
        if twin is not None:
            free_arm = make_held_arm(plant, handle, path, X_PH, None)
            wrench, force, handle_state = add_arm_twin(
                builder, twin, plant, hand_impedance, free_arm
            )
        builder.Connect(force, plant.get_applied_generalized_force_input_port())
        builder.ExportInput(wrench, "F_applied")
        export_parts(builder, handle_state, {"X_WH": 7, "V_WH": 6})
        builder.BuildInto(self)


def weld_hand(plant: MultibodyPlant, handle: RigidBody, grip: HandGrip) -> None:
    """Adds the mass of a hand to a handle.

    Args:
        plant: Not finalized.
        handle: Its body that is held.
        grip: How it is held.
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
        model: SDF with a link `base`.
        X_WB: Where that link stands.
    """
    plant = MultibodyPlant(0.0)
    # From a file Drake takes 25 ms longer, and does no more with it.
    Parser(plant).AddModelsFromString(
        model.read_text(encoding="utf-8"), model.suffix.removeprefix(".")
    )
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"), X_WB)
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    return plant
