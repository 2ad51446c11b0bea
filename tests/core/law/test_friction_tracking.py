"""Test what contacts keep of their friction from tick to tick."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import pose
from friction_bodies import floor, sled
from friction_oracle import matrix
from friction_rig import (
    LAW,
    STIFFNESS_N_PER_M,
    TOLERANCE_M,
    FrictionRig,
    at,
    make_model,
    one_foot,
)
from scipy.spatial.transform import Rotation
from slide_rig import make_slide_tools
from slide_scenes import fifty_pieces, fifty_pieces_path
from wrench_chain import push

from drake_haptics import _core


def test_a_tool_at_rest_stays_under_its_force_to_the_last_bit() -> None:
    rig = one_foot()
    at(rig, 0, 0, 1.0)
    first = at(rig, 4e-5, 3e-5, 1.0)
    for _ in range(100):
        later = at(rig, 4e-5, 3e-5, 1.0)
    np.testing.assert_array_equal(
        later.friction.f_cluster_W, first.friction.f_cluster_W
    )
    np.testing.assert_array_equal(later.friction.next_state, first.friction.next_state)


def test_adhesion_turns_with_the_bodies() -> None:
    rig = FrictionRig(
        sled([0, 0, 0]), [floor()], make_model(moves=[True]), moves=[True]
    )
    at(rig, 0, 0, 2.0)
    held = at(rig, 5e-5, 0, 2.0).friction_force
    place = rig.state[:7].copy()
    for angle in np.linspace(0, np.pi / 2, 30):
        x, y, z, w = Rotation.from_rotvec([0, 0, angle]).as_quat()
        rig.q_WO[0] = pose([0.2 * angle, 0, 0], (w, x, y, z))
        X = matrix(rig.q_WO[0])
        p = X[:3, :3] @ place[4:] + X[:3, 3]
        rig.state[:7] = pose(p, (w, x, y, z))
        tick = rig.look()
        rig.remember(tick)
    np.testing.assert_allclose(tick.friction_force, [0, held[0], 0], atol=1e-9)


def test_pressing_harder_adds_no_force_and_pressing_less_bounds_it() -> None:
    rig, mu_s = one_foot(), LAW.static_ratio * LAW.coefficient[0]
    at(rig, 0, 0, 1.0)
    x = LAW.break_away_m / 2
    first = np.linalg.norm(at(rig, x, 0, 1.0).friction_force)
    assert first == pytest.approx(mu_s / 2)
    # While N falls by less than half of the most there was, the force stays.
    for N in (1.2, 0.9, 5.0, 3.0, 5.0, 9.0, 5.0):
        f = np.linalg.norm(at(rig, x, 0, N).friction_force)
        assert f == pytest.approx(first, rel=1e-3)
    for N in (2.0, 0.4, 0.1, 0.01, 1e-4):
        weaker = np.linalg.norm(at(rig, x, 0, N).friction_force)
        assert weaker <= min(f, mu_s * N)
        f = weaker
    assert np.linalg.norm(at(rig, x, 0, 9.0).friction_force) == pytest.approx(f)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("step_m", [1e-5, 1e-4], ids=["mostly sticks", "mostly slides"])
def test_no_motion_under_any_force_makes_energy(seed: int, step_m: float) -> None:
    """Work done on a tool that is led at random, turned, tilted and pressed."""
    rng = np.random.default_rng(seed)
    feet = 0.01 * np.array([[-1, -1, 0], [-1, 1, 0], [1, -1, 0], [1, 1, 0]])
    rig = FrictionRig(sled(feet), [floor()], make_model())
    place, turn, press = np.zeros(2), np.zeros(3), 1.0
    work, sliding = 0.0, []
    for _ in range(1500):
        place = 0.97 * (place + step_m * rng.normal(size=2))
        turn = 0.97 * (turn + step_m / 0.01 * rng.normal(size=3) * [0.3, 0.3, 1])
        press = np.clip(press * np.exp(0.3 * rng.normal()), 0.01, 3.0)
        last = rig.state[:7].copy()
        x, y, z, w = Rotation.from_rotvec(turn).as_quat()
        rig.state[:7] = pose([*place, TOLERANCE_M - 2e-4 * press], (w, x, y, z))
        tick = rig.look()
        rig.remember(tick)
        # Where the tool's points that are now at the contacts were a tick ago.
        now_to_last = matrix(last) @ np.linalg.inv(matrix(rig.state[:7]))
        p = tick.clusters.p_WC
        p_last = p @ now_to_last[:3, :3].T + now_to_last[:3, 3]
        work += (tick.friction.f_cluster_W * (p - p_last)).sum()
        assert work + tick.friction.stored_J <= 1e-15
        sliding.extend(tick.friction.sliding)
    assert work < -1e-6
    assert 0.01 < np.mean(sliding) < 0.99


def test_a_new_contact_starts_without_force() -> None:
    rig = one_foot()
    at(rig, 0, 0, 1.0)
    at(rig, 5e-5, 0, 1.0)
    rig.state[6] += 0.1
    rig.remember(rig.look())
    assert not at(rig, 5e-5, 0, 1.0).friction_force.any()


@pytest.mark.parametrize("name", ["box", "wide box", "ball", "spike", "edge"])
def test_sliding_over_seams_has_the_friction_of_one_face(name: str) -> None:
    rig = FrictionRig(make_slide_tools()[name], [fifty_pieces()], make_model())
    N, mu = 1.0, LAW.coefficient[0]
    path = fifty_pieces_path(TOLERANCE_M - N / STIFFNESS_N_PER_M)
    direction = (path[-1] - path[0]) / np.linalg.norm(path[-1] - path[0])
    ratios, counts = [], set()
    for p in path:
        rig.state[4:7] = p
        tick = rig.look()
        rig.remember(tick)
        ratios.append(tick.friction_force / tick.normal_force)
        counts.add(len(tick.clusters))
    assert len(counts) > 1
    away = np.array(ratios[5:]) + mu * direction
    assert np.linalg.norm(away, axis=1).max() < 0.01 * mu


def test_a_tool_that_shifts_its_weight_takes_its_friction_along() -> None:
    """Two feet, under a force that both bear; then one rocks off the floor."""
    rig = FrictionRig(sled([[-1e-3, 0, 0], [1e-3, 0, 0]]), [floor()], make_model())
    at(rig, 0, 0, 1.0)
    held = at(rig, 0, 5e-5, 1.0)
    pivot = held.clusters.p_WC.mean(axis=0)
    pivot_T = pivot - rig.state[4:7]
    bears = []
    for angle in np.linspace(0, 0.1, 100):
        turn = Rotation.from_rotvec([0, angle, 0])
        x, y, z, w = turn.as_quat()
        # The foot on the right goes no deeper than it was.
        lift = np.array([0, 0, 1e-3 * np.sin(angle)])
        rig.state[:7] = pose(pivot + lift - turn.apply(pivot_T), (w, x, y, z))
        tick = rig.look()
        rig.remember(tick)
        bears.append(np.linalg.norm(tick.wrench.f_cluster_W, axis=1))
    assert len(bears[0]) == 2 and len(bears[-1]) == 1
    # One foot bears less than two, and what it bears holds as well as before.
    part = bears[-1].sum() / bears[0].sum()
    assert 0.7 < part <= 1.0
    kept = tick.friction_force[1] / held.friction_force[1]
    assert 0.95 * part < kept <= 1.0


def test_contacts_that_merge_or_split_keep_the_sum_of_forces() -> None:
    """The paper's clusters of a foot pair: one or two by the leaf's size."""
    rig = FrictionRig(sled([[-1.5e-3, 0, 0], [1.5e-3, 0, 0]]), [floor()], make_model())
    at(rig, 0, 0, 1.0)
    before = at(rig, 3e-5, 4e-5, 1.0)
    assert len(before.clusters) == 2
    tracker = _core.SceneTracker(
        sled([[-1.5e-3, 0, 0], [1.5e-3, 0, 0]]), [floor()], TOLERANCE_M
    )
    contacts = tracker.query(rig.state[:7])
    merged = _core.cluster_contacts(contacts, 10e-3, TOLERANCE_M)
    assert len(merged) == 1
    wrench = push(merged, 2 * STIFFNESS_N_PER_M, p_WTo=rig.state[4:7])
    one = make_model().step(
        rig.memory, merged, wrench, rig.state[:7].copy(), np.zeros(0)
    )
    np.testing.assert_allclose(
        one.f_cluster_W.sum(axis=0), before.friction_force, rtol=0.01
    )
    rig.memory = one.next_state
    two = rig.look()
    np.testing.assert_allclose(two.friction_force, before.friction_force, rtol=0.02)
