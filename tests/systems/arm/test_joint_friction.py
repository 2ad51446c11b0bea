"""Dry friction: it holds, it slides, it only ever takes energy."""

import numpy as np
import pytest
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Adder, ConstantVectorSource
from twin_rig import MOTORS, PERIOD, S, load_plant, make_simulator

from drake_haptics.systems.arm.joint_friction import JointFriction

COULOMB = np.array(MOTORS.coulomb_friction_Nm)


class PushedArm:
    """The arm, free but for its friction, with constant torques of its motors."""

    def __init__(self, motor_torque, viscous=0.0):
        builder = DiagramBuilder()
        self.plant = builder.AddSystem(load_plant().Clone())
        friction = JointFriction(
            self.plant, PERIOD, S, COULOMB, np.full(6, float(viscous))
        )
        self.friction = builder.AddSystem(friction)
        # τ = S⁻ᵀ τ_motor, so that τ·v is the motors' power.
        push = builder.AddSystem(
            ConstantVectorSource(np.linalg.solve(S.T, np.array(motor_torque)))
        )
        total = builder.AddSystem(Adder(2, 6))
        state = self.plant.get_state_output_port()
        for output, input in [
            (state, friction.get_input_port()),
            (friction.get_output_port(), total.get_input_port(0)),
            (push.get_output_port(), total.get_input_port(1)),
            (
                total.get_output_port(),
                self.plant.get_applied_generalized_force_input_port(),
            ),
        ]:
            builder.Connect(output, input)
        self.simulator = make_simulator(builder.Build())
        root = self.simulator.get_context()
        self._at = [part.GetMyContextFromRoot(root) for part in (self.plant, friction)]

    def run(self, duration_s, v0=None):
        """Returns motor angles, motor speeds, motor friction, stored and kinetic J."""
        if v0 is not None:
            context = self.plant.GetMyMutableContextFromRoot(
                self.simulator.get_mutable_context()
            )
            self.plant.SetVelocities(context, np.array(v0, float))
        rows = []

        def note(_):
            plant, friction = self._at
            state = self.plant.get_state_output_port().Eval(plant).reshape(2, 6)
            motors = state @ np.linalg.inv(S).T
            torque = S.T @ self.friction.get_output_port().Eval(friction)
            stored = self.friction.calc_stored_energy(friction)
            kinetic = self.plant.EvalKineticEnergy(plant)
            rows.append((motors[0], motors[1], torque, stored, kinetic))

        self.simulator.set_monitor(note)
        self.simulator.AdvanceTo(duration_s)
        return [np.array(column) for column in zip(*rows, strict=True)]


@pytest.mark.parametrize("share", [0.1, 0.5, 0.99])
def test_below_breakaway_it_holds_without_creep_and_without_chatter(share):
    signs = np.array([1, -1, 1, -1, 1, 1])
    arm = PushedArm(share * signs * COULOMB)
    angles, speeds, torque, _, _ = arm.run(1.0)
    # A torque that comes at once, and is nearly all that friction holds, swings the
    # motor beyond breakaway first.
    way = angles[-1] - angles[0]
    assert (
        np.abs(way) < (1 if share < 0.9 else 20) * arm.friction.break_away_rad
    ).all()
    # Then the arm stands, and its friction does not change any more.
    assert np.abs(speeds[-500:]).max() < 1e-15
    assert np.ptp(angles[-500:], axis=0).max() < 1e-15
    held = np.tile(share * signs * COULOMB, (500, 1))
    np.testing.assert_allclose(torque[-500:], -held, rtol=1e-9)


def test_it_gives_way_by_less_than_the_step_of_an_encoder():
    arm = PushedArm(np.zeros(6))
    assert (arm.friction.break_away_rad < np.array(MOTORS.encoder_step_rad)).all()


@pytest.mark.parametrize("motor", range(6))
def test_above_breakaway_it_slides_against_just_that_torque(motor):
    push = np.zeros(6)
    push[motor] = 1.5 * COULOMB[motor]
    _, speeds, torque, _, _ = PushedArm(push).run(0.05)
    assert speeds[-1, motor] > 0.01
    np.testing.assert_allclose(torque[20:, motor], -COULOMB[motor], rtol=1e-12)
    assert (np.abs(torque) <= COULOMB * (1 + 1e-12)).all()


def test_viscous_friction_grows_with_speed():
    _, speeds, dry, _, _ = PushedArm(np.zeros(6)).run(0.01, v0=np.ones(6))
    _, faster, both, _, _ = PushedArm(np.zeros(6), viscous=1e-3).run(
        0.01, v0=np.ones(6)
    )
    assert (speeds[:3] > 0.0).any()
    sliding = (dry[0] == -COULOMB) & (faster[0] > 0.5)
    assert sliding.any()
    np.testing.assert_allclose(
        both[0][sliding], (-COULOMB - 1e-3 * faster[0])[sliding], rtol=1e-12
    )


@pytest.mark.parametrize("seed", range(5))
def test_a_swing_ends_and_energy_only_falls(seed):
    v0 = np.random.default_rng(seed).normal(size=6) * [0.5, 0.5, 0.5, 5, 5, 5]
    _, speeds, _, stored, kinetic = PushedArm(np.zeros(6)).run(2.0, v0=v0)
    energy = stored + kinetic
    # What a step of the integrator, of second order, may err by.
    assert np.diff(energy).max() < 1e-5 * energy[0]
    assert kinetic[-1] < 1e-20 * energy[0]
    assert np.abs(speeds[-1]).max() < 1e-9


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"period_s": 0.0}, "period_s must be positive"),
        ({"coulomb_Nm": -COULOMB}, "coulomb_Nm must be at least 0"),
        ({"viscous_Nms_per_rad": -np.ones(6)}, "viscous_Nms_per_rad must be at"),
        ({"coulomb_Nm": np.full(6, np.nan)}, "coulomb_Nm must be at least 0"),
    ],
)
def test_what_is_no_friction_is_refused(change, message):
    arguments = {
        "period_s": PERIOD,
        "joint_per_motor": S,
        "coulomb_Nm": COULOMB,
        "viscous_Nms_per_rad": np.zeros(6),
    }
    with pytest.raises(ValueError, match=message):
        JointFriction(load_plant(), **(arguments | change))
