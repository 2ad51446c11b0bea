"""Encoders: counted angles, estimated speeds, no tick lost."""

import numpy as np
import pytest
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import TrajectorySource, ZeroOrderHold
from pydrake.trajectories import PiecewisePolynomial
from twin_rig import HANDLE_PATH, MOTORS, PERIOD, S, load_plant, make_simulator

from drake_haptics.systems.arm.hand_impedance import make_held_arm
from drake_haptics.systems.arm.joint_encoder import JointEncoder

STEP = np.array(MOTORS.encoder_step_rad)
TICKS = 60


def make_kinematics():
    plant = load_plant()
    handle = plant.GetBodyByName("handle")
    return make_held_arm(plant, handle, HANDLE_PATH, RigidTransform(), None)


def make_encoder(window=4, **change):
    arguments = {
        "period_s": PERIOD,
        "joint_per_motor": S,
        "step_rad": STEP,
        "velocity_window": window,
    }
    return JointEncoder(load_plant(), make_kinematics(), **(arguments | change))


def make_motion():
    """Returns joint angles over time, some slow, some fast, from a place of its own."""
    rng = np.random.default_rng(6)
    times = np.linspace(0.0, 0.1, 8)
    knots = 0.3 + np.cumsum(rng.normal(size=(6, 8)) * 0.02, axis=1)
    return PiecewisePolynomial.CubicShapePreserving(times, knots)


def follow(encoder):
    """Returns the handle's states (ticks, 13) as a hold at each tick samples them."""
    builder = DiagramBuilder()
    builder.AddSystem(encoder)
    angles = make_motion()
    times = np.linspace(0.0, 0.1, 2001)
    q = angles.vector_values(times)
    state = PiecewisePolynomial.FirstOrderHold(times, np.vstack([q, 0 * q + 99.0]))
    source = builder.AddSystem(TrajectorySource(state))
    hold = builder.AddSystem(ZeroOrderHold(PERIOD, 13))
    builder.Connect(source.get_output_port(), encoder.GetInputPort("arm_state"))
    builder.Connect(encoder.GetOutputPort("handle_state"), hold.get_input_port())
    simulator = make_simulator(builder.Build())
    rows = []
    context = hold.GetMyContextFromRoot(simulator.get_context())
    simulator.Initialize()
    simulator.set_monitor(
        lambda _: rows.append(hold.get_output_port().Eval(context).copy())
    )
    simulator.AdvanceTo(TICKS * PERIOD)
    return np.array(rows)


def calc_expected(window):
    """Returns the same by numpy, of the definition."""
    q = make_motion().vector_values(np.arange(TICKS) * PERIOD)
    motors = np.linalg.solve(S, q)
    counted = np.rint(motors / STEP[:, None]) * STEP[:, None]
    before = np.column_stack([counted[:, :1]] * window + [counted])[:, :TICKS]
    speeds = (counted - before) / (window * PERIOD)
    states = np.vstack([S @ counted, S @ speeds]).T
    arm = make_kinematics()
    return np.array([arm.calc_handle_state(state) for state in states])


@pytest.mark.parametrize("window", [1, 2, 4, 9])
def test_a_hold_of_the_same_tick_samples_what_was_just_counted(window):
    states = follow(make_encoder(window))
    assert states.shape == (TICKS, 13)
    np.testing.assert_allclose(states, calc_expected(window), atol=1e-12)


def test_the_handle_is_off_by_half_a_step_at_most():
    # Away from zero the tip moves by 0.215 m per radian of a motor, at most.
    exact = make_kinematics()
    q = make_motion().vector_values(np.arange(TICKS) * PERIOD)
    truth = np.array([exact.calc_handle_state(np.append(x, np.zeros(6))) for x in q.T])
    off = np.linalg.norm(follow(make_encoder())[:, 4:7] - truth[:, 4:7], axis=1)
    bound = 0.5 * (STEP[0] * 0.385 + STEP[1] * 0.215 + STEP[2] * 0.170)
    assert 0.1 * bound < off.max() < bound


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"period_s": 0.0}, "period_s must be positive"),
        ({"step_rad": 0.0 * STEP}, "step_rad must be positive"),
        ({"step_rad": np.full(6, np.nan)}, "step_rad must be positive"),
        ({"velocity_window": 0}, "velocity_window must be at least 1"),
    ],
)
def test_what_is_no_encoder_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        make_encoder(**change)
