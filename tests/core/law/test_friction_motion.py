"""Test a free tool under friction against mechanics, in the core's closed loop."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import hull, pose
from friction_bodies import floor, sled
from friction_rig import PERIOD_S, STIFFNESS_N_PER_M, TOLERANCE_M, FrictionRig
from scipy.spatial.transform import Rotation

from drake_haptics import _core

MU, RATIO, BREAK_AWAY_M = 0.5, 1.2, 1e-4
MASS_KG, G = 0.1, 9.81
FEET_M = 0.02 * np.array([[-1, -1, 0], [-1, 1, 0], [1, -1, 0], [1, 1, 0]])


def block(moves: bool = False, ratio: float = RATIO) -> FrictionRig:
    """A sled on a floor, its center of mass between its four tips."""
    model = _core.StickSlipModel([MU], [moves], ratio, BREAK_AWAY_M, 5e-3)
    inertia = MASS_KG * 0.02**2 * np.eye(3)
    dynamics = _core.RigidToolDynamics(MASS_KG, np.zeros(3), inertia)
    rig = FrictionRig(sled(FEET_M), [floor()], model, moves=[moves], dynamics=dynamics)
    # It floats on the layer in which contacts push. What friction remembers of how
    # it came to rest there is forgotten.
    rig.state[6] = TOLERANCE_M - MASS_KG * G / STIFFNESS_N_PER_M
    for _ in range(200):
        rig.advance(weight())
    rig.state[7:] = 0
    rig.forget()
    return rig


def weight(slope_rad: float = 0.0) -> np.ndarray:
    """On a slope that goes down along x, as a wrench in the frame of the slope."""
    f = MASS_KG * G * np.array([np.sin(slope_rad), 0, -np.cos(slope_rad)])
    return np.concatenate([np.zeros(3), f])


@pytest.mark.parametrize("turn", [0.0, 0.6])
def test_a_dragged_block_breaks_away_and_slides(turn: float) -> None:
    rig = block()
    along, speed, spring = np.array([np.cos(turn), np.sin(turn), 0]), 2e-3, 5e3
    K = np.zeros((6, 6))
    K[3:, 3:] = spring * np.outer(along, along)
    forces, slid = [], []
    for i in range(1500):
        pull = spring * (speed * PERIOD_S * i - along @ rig.state[4:7])
        tick = rig.advance(weight() + np.concatenate([np.zeros(3), pull * along]), K)
        forces.append(-along @ tick.friction_force / tick.normal_force)
        slid.append(along @ tick.state[4:7])
    forces, slid = np.array(forces), np.array(slid)
    start = np.argmax(forces)
    # In a tick before it breaks away the block moves no farther than its handle.
    assert forces[start] == pytest.approx(
        RATIO * MU, rel=speed * PERIOD_S / BREAK_AWAY_M
    )
    assert slid[start] == pytest.approx(BREAK_AWAY_M, rel=0.03)
    np.testing.assert_allclose(forces[-200:], MU, rtol=1e-6)
    assert slid[-1] - slid[-201] == pytest.approx(200 * speed * PERIOD_S, rel=0.01)


def test_a_soft_spring_makes_it_stick_and_slip_again_and_again() -> None:
    rig, spring, sticks = block(ratio=1.4), 100.0, []
    K = np.zeros((6, 6))
    K[3, 3] = spring
    for i in range(4000):
        pull = spring * (5e-3 * PERIOD_S * i - rig.state[4])
        tick = rig.advance(weight() + np.array([0, 0, 0, pull, 0, 0]), K)
        # Stuck, and under more than what slides would bear.
        share = -tick.friction_force[0] / (MU * tick.normal_force)
        sticks.append(share > 1.3 and not tick.friction.sliding.any())
    assert np.count_nonzero(np.diff(sticks)) >= 6


@pytest.mark.parametrize("below", [0.8, 0.97])
def test_a_block_on_a_slope_within_the_static_cone_rests(below: float) -> None:
    rig, steepest = block(), np.arctan(below * RATIO * MU)
    for i in range(3000):
        tick = rig.advance(weight(steepest * min(1, i / 2000)))
    assert np.linalg.norm(rig.state[10:]) < 1e-9
    assert not tick.friction.sliding.any()
    # Its normal force was larger on the flat, and held it by as much more.
    assert rig.state[4] == pytest.approx(
        below * np.cos(steepest) * BREAK_AWAY_M, rel=0.01
    )


@pytest.mark.parametrize("tangent", [0.65, 0.9, 1.5])
def test_a_block_on_a_steeper_slope_slides_as_mechanics_say(tangent: float) -> None:
    rig, slope = block(), np.arctan(tangent)
    speeds = []
    for _ in range(400):
        rig.advance(weight(slope))
        speeds.append(rig.state[10])
    expected = G * (np.sin(slope) - MU * np.cos(slope))
    measured = (speeds[-1] - speeds[-201]) / (200 * PERIOD_S)
    assert measured == pytest.approx(expected, rel=1e-4)


def test_a_sliding_block_comes_to_rest_where_its_energy_is_spent() -> None:
    rig, v = block(), 0.3
    start = rig.state.copy()
    # It comes in flight: a tick before it lands it is as high, but further back.
    rig.state[10] = v
    rig.state[4] -= v * PERIOD_S
    rig.remember(rig.look())
    rig.state[4] = start[4]
    for _ in range(400):
        rig.advance(weight())
    assert np.linalg.norm(rig.state[7:]) < 1e-6
    path = rig.state[4] - start[4]
    # A step early or late, and the grip of the first break-away.
    assert path == pytest.approx(
        v**2 / (2 * MU * G), abs=v * PERIOD_S + 2 * BREAK_AWAY_M
    )


def test_a_block_that_lands_fast_is_braked_within_the_cone() -> None:
    rig, v = block(), np.array([0.4, 0, -0.05])
    rig.state[6] = TOLERANCE_M + 2e-4
    rig.state[10:] = v
    impulse = np.zeros(3)
    for _ in range(30):
        tick = rig.advance(weight())
        impulse += tick.normal_force * PERIOD_S
        lost = MASS_KG * (v[0] - rig.state[10])
        # What the implicit step adds to the force of a tick: N may double in it.
        most = impulse[2] + tick.normal_force * PERIOD_S
        assert lost <= RATIO * MU * most * 1.01
    assert lost > 0.5 * MU * impulse[2]


@pytest.mark.parametrize("tremor", [0.0, 0.25], ids=["steady", "trembling"])
def test_a_tangential_load_within_the_cone_makes_no_drift(tremor: float) -> None:
    """20 s; the second hand presses now more, now less, ten times a second."""
    rig, load = block(), np.zeros(6)
    load[3:5] = 0.5 * RATIO * MU * MASS_KG * G * np.array([0.6, 0.8])
    load[2] = 2e-3  # N·m, about the normal
    places = []
    for i in range(20000):
        press = 1 + tremor * np.sin(2 * np.pi * 10 * i * PERIOD_S)
        rig.advance(weight() * press + load)
        if i in (999, 19999):
            places.append(np.concatenate([rig.state[:2], rig.state[4:6]]))
    drift = np.abs(places[1] - places[0]).max()
    assert drift < 1e-9 if tremor == 0.0 else drift < 1e-6


def test_a_conveyor_carries_the_block_along() -> None:
    rig, v, w = block(moves=True), 0.05, 0.5
    place = rig.state[4:6].copy()
    for i in range(1000):
        # Half a second of speeding up, half a second of it: below the cone.
        speed = min(1.0, i / 500)
        rig.V_WO[0] = [0, 0, w * speed, v * speed, 0, 0]
        rig.advance(weight())
        angle = w * speed * PERIOD_S
        q = rig.q_WO[0]
        R = Rotation.from_rotvec([0, 0, angle]) * Rotation.from_quat(np.roll(q[:4], -1))
        x, y, z, s = R.as_quat()
        rig.q_WO[0] = pose(q[4:] + PERIOD_S * rig.V_WO[0, 3:], (s, x, y, z))
    turned = Rotation.from_quat(np.roll(rig.q_WO[0, :4], -1)).as_matrix()
    carried = rig.q_WO[0, 4:] + turned @ np.append(place, 0)
    assert carried[0] > 0.03
    np.testing.assert_allclose(rig.state[4:6], carried[:2], atol=BREAK_AWAY_M)
    np.testing.assert_allclose(
        rig.state[:4] * np.sign(rig.state[0]), rig.q_WO[0, :4], atol=2e-3
    )


def test_rolling_makes_no_friction() -> None:
    """A prism of 36 sides tips from edge to edge over the floor, none of them slips."""
    sides, radius = 36, 0.01
    angles = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    rim = radius * np.stack([np.cos(angles), 0 * angles, np.sin(angles)], axis=1)
    along = np.array([0, 1, 0])
    wheel = hull(np.concatenate([rim - 5e-3 * along, rim + 5e-3 * along]))
    model = _core.StickSlipModel([MU], [False], RATIO, BREAK_AWAY_M, 5e-3)
    rig = FrictionRig(wheel, [floor()], model)
    half, worst = np.pi / sides, 0.0
    side = 2 * radius * np.sin(half)
    for turn in np.arange(0, 4 * np.pi, 0.02):  # 20 rad/s
        tipped = np.floor(turn / (2 * half))
        lean = turn - (2 * tipped + 1) * half
        pivot = side * (tipped + 0.5)
        height = radius * np.cos(lean)
        quaternion = (np.cos(turn / 2), 0, np.sin(turn / 2), 0)
        rig.state[:7] = pose([pivot + radius * np.sin(lean), 0, height], quaternion)
        tick = rig.look()
        rig.remember(tick)
        assert tick.normal_force > 1.0
        worst = max(worst, np.linalg.norm(tick.friction_force) / tick.normal_force)
    assert rig.state[4] > 0.12
    # Before an edge arrives there is a gap below it, and a contact is half-way: for
    # a tick or two the wheel seems to slip by half the tolerance times the turn.
    assert worst < 2 * TOLERANCE_M / 2 * 0.02 / BREAK_AWAY_M * MU
