"""Gives a simulated arm the faults of a real one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import DiagramBuilder, InputPort, OutputPort
from pydrake.systems.primitives import Adder, ConstantVectorSource

from drake_haptics._core import ArmDynamics
from drake_haptics.systems.arm.force_delay import ForceDelay
from drake_haptics.systems.arm.hand_impedance import HandImpedance
from drake_haptics.systems.arm.joint_encoder import JointEncoder
from drake_haptics.systems.arm.joint_friction import JointFriction
from drake_haptics.systems.arm.motor_torque import MotorTorque


@dataclass(frozen=True, eq=False)
class ArmTwin:
    """The faults of a real arm. A part that is None or 0 is not in the diagram.

    All angles and torques of motors are after their gears.

    Attributes:
        period_s: The tick, s.
        joint_per_motor: S (6, 6) in q = S q_motor, so that τ_motor = Sᵀ τ.
        encoder_step_rad: (6,) angle per count of each encoder, rad; see `JointEncoder`.
        velocity_window: Window of the encoders' speed, ticks.
        coulomb_Nm: (6,) dry friction, N·m; see `JointFriction`.
        viscous_Nms_per_rad: (6,) viscous friction, N·m·s/rad.
        delay_samples: Delay of the wrench, ticks; see `ForceDelay`.
        peak_torque_Nm: (6,) peak torque, N·m; see `MotorTorque`.
    """

    period_s: float
    joint_per_motor: np.ndarray
    encoder_step_rad: np.ndarray | None = None
    velocity_window: int = 1
    coulomb_Nm: np.ndarray | None = None
    viscous_Nms_per_rad: np.ndarray | None = None
    delay_samples: int = 0
    peak_torque_Nm: np.ndarray | None = None


def add_arm_twin(
    builder: DiagramBuilder,
    twin: ArmTwin,
    plant: MultibodyPlant,
    hand: HandImpedance,
    free_arm: ArmDynamics,
) -> tuple[InputPort, OutputPort, OutputPort]:
    """Adds the parts of a twin between an arm and its ports.

    Args:
        builder: Builder of the arm's diagram; the caller connects the arm's state to
            the hand.
        twin: Parts to add.
        plant: Finalized plant of the arm, at its default angles.
        hand: Hand that holds the arm.
        free_arm: Kinematics of the arm without a hand.

    Returns:
        The input for the wrench that the device is to render, the arm's generalized
        force, and the handle's state, as in `HandImpedance`.

    Raises:
        ValueError: A value is out of range.
    """
    S = twin.joint_per_motor
    arm_state = plant.get_state_output_port()
    wrench = hand.GetInputPort("F_Ho_W_rendered")
    forces = [hand.GetOutputPort("generalized_force")]
    handle_state = hand.GetOutputPort("handle_state")
    if twin.peak_torque_Nm is not None:
        motors = builder.AddNamedSystem(
            "motor_torque", MotorTorque(free_arm, S, twin.peak_torque_Nm)
        )
        builder.Connect(arm_state, motors.GetInputPort("arm_state"))
        # The hand no longer passes the wrench on.
        nothing = builder.AddNamedSystem("no_wrench", ConstantVectorSource(np.zeros(6)))
        builder.Connect(nothing.get_output_port(), wrench)
        wrench = motors.GetInputPort("F_Ho_W_rendered")
        forces.append(motors.get_output_port())
    if twin.coulomb_Nm is not None:
        viscous = twin.viscous_Nms_per_rad
        friction = builder.AddNamedSystem(
            "joint_friction",
            JointFriction(
                plant,
                twin.period_s,
                S,
                twin.coulomb_Nm,
                np.zeros(6) if viscous is None else viscous,
            ),
        )
        builder.Connect(arm_state, friction.get_input_port())
        forces.append(friction.get_output_port())
    if twin.delay_samples > 0:
        delay = builder.AddNamedSystem(
            "force_delay", ForceDelay(twin.period_s, twin.delay_samples)
        )
        builder.Connect(delay.get_output_port(), wrench)
        wrench = delay.get_input_port()
    if twin.encoder_step_rad is not None:
        encoder = builder.AddNamedSystem(
            "joint_encoder",
            JointEncoder(
                plant,
                free_arm,
                twin.period_s,
                S,
                twin.encoder_step_rad,
                twin.velocity_window,
            ),
        )
        builder.Connect(arm_state, encoder.GetInputPort("arm_state"))
        handle_state = encoder.GetOutputPort("handle_state")
    return wrench, _add(builder, forces), handle_state


def _add(builder: DiagramBuilder, forces: list[OutputPort]) -> OutputPort:
    """Returns the sum of generalized forces; a single force needs no system."""
    if len(forces) == 1:
        return forces[0]
    total = builder.AddNamedSystem("generalized_force", Adder(len(forces), 6))
    for i, force in enumerate(forces):
        builder.Connect(force, total.get_input_port(i))
    return total.get_output_port()
