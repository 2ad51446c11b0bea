"""Test friction of a tool against its formulas in NumPy, and its sum."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import IDENTITY, pose
from friction_bodies import burr, floor, sled
from friction_oracle import Law, Touch, matrix, step
from friction_rig import FrictionRig, Tick, at, make_model, one_foot
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def small_motion(rng: np.random.Generator, q: np.ndarray, scale_m: float) -> np.ndarray:
    """A pose near q: within some `scale_m`, and as many 1/30 m of turn."""
    R = Rotation.from_rotvec(rng.normal(size=3) * scale_m / 0.03)
    x, y, z, w = (R * Rotation.from_quat(np.roll(q[:4], -1))).as_quat()
    return pose(q[4:] + rng.normal(size=3) * scale_m, (w, x, y, z))


def wander(seed: int, ticks: int = 40) -> tuple[list[Tick], list[np.ndarray], Law]:
    """Random motion of a burr of spikes over two objects, one of which moves."""
    rng = np.random.default_rng(seed)
    law = Law((0.4, 0.7), 1.3, 1e-4, 5e-3)
    tool, plates = burr(rng, 6)
    moves = [False, True]
    still, moving = plates, plates
    rig = FrictionRig(tool, [still, moving], make_model(law, moves), moves=moves)
    rig.q_WO[1, 4:] += 5e-4
    scale = 10 ** rng.uniform(-4.7, -4.2)
    seen, poses = [], []
    for _ in range(ticks):
        rig.state[:7] = small_motion(rng, IDENTITY, scale)
        rig.q_WO[1] = small_motion(rng, pose([5e-4] * 3), scale / 2)
        poses.append(rig.q_WO[1].copy())
        seen.append(rig.look())
        rig.remember(seen[-1])
    return seen, poses, law


def touches(tick: Tick) -> list[Touch]:
    c = tick.clusters
    forces = np.linalg.norm(tick.wrench.f_cluster_W, axis=1)
    return [
        Touch(int(c.object_index[i]), c.p_WC[i], c.nhat_BA_W[i], forces[i])
        for i in range(len(c))
        if forces[i] > 0
    ]


@pytest.mark.parametrize("seed", range(6))
def test_forces_and_memory_agree_with_the_formulas(seed: int) -> None:
    ticks, q_WO, law = wander(seed)
    last: list[Touch] = []
    X_last = [matrix(IDENTITY)] * 2
    still = (np.eye(4), np.eye(4))
    slid, stuck = 0, 0
    for tick, q in zip(ticks, q_WO, strict=True):
        now = touches(tick)
        assert len(now) <= 32
        X = [matrix(tick.state[:7]), matrix(q)]
        f = step(last, now, (X_last[0], X[0]), [still, (X_last[1], X[1])], law)
        loaded = np.linalg.norm(tick.wrench.f_cluster_W, axis=1) > 0
        np.testing.assert_allclose(
            tick.friction.f_cluster_W[loaded], f, rtol=1e-6, atol=1e-9
        )
        slots = np.array(tick.friction.next_state)[14:].reshape(32, 12)
        for slot, t in zip(slots, now, strict=False):
            np.testing.assert_allclose(slot[7:10], t.z, rtol=1e-6, atol=1e-13)
            np.testing.assert_allclose(
                slot[10:], [t.load, t.grip], rtol=1e-6, atol=1e-12
            )
        assert not slots[len(now) :].any()
        sliding = tick.friction.sliding[loaded]
        slid, stuck = slid + sliding.sum(), stuck + (~sliding).sum()
        last, X_last = now, X
    assert slid > 20 and stuck > 20


@pytest.mark.parametrize("change", [-1e-9, 1e-9])
def test_an_object_is_found_again_after_a_small_change_of_the_state(
    change: float,
) -> None:
    """Numerical differentiation changes every number of the state by a little."""
    rng = np.random.default_rng(0)
    moves, law = [False, True], Law((0.4, 0.7), 1.3, 1e-4, 5e-3)
    tool, plates = burr(rng, 6)
    rig = FrictionRig(tool, [plates] * 2, make_model(law, moves), moves=moves)
    rig.remember(rig.look())
    rig.state[4:6] += 2e-5
    before = rig.look()
    assert set(before.clusters.object_index) == {0, 1}
    assert np.abs(before.friction_force).max() > 0.1
    rig.memory = np.array(rig.memory)
    rig.memory[14:].reshape(32, 12)[:, 0] += change
    np.testing.assert_array_equal(rig.look().friction_force, before.friction_force)


@pytest.mark.parametrize("seed", range(10, 16))
def test_no_force_leaves_the_cone_or_the_tangent_plane(seed: int) -> None:
    ticks, _, law = wander(seed)
    for tick in ticks:
        c, f = tick.clusters, tick.friction.f_cluster_W
        N = np.linalg.norm(tick.wrench.f_cluster_W, axis=1)
        limit = np.array(law.coefficient)[c.object_index] * law.static_ratio * N
        assert (np.linalg.norm(f, axis=1) <= limit * (1 + 1e-12)).all()
        np.testing.assert_allclose((f * c.nhat_BA_W).sum(axis=1), 0, atol=1e-12)


@pytest.mark.parametrize("seed", range(20, 24))
def test_the_wrench_sums_the_forces_and_its_stiffness_never_pushes(seed: int) -> None:
    for tick in wander(seed, 20)[0]:
        F, K, B = np.split(tick.friction.wrench_model, [6, 42])
        f, r = tick.friction.f_cluster_W, tick.clusters.p_WC - tick.state[4:7]
        np.testing.assert_allclose(F[3:], f.sum(axis=0), atol=1e-12)
        np.testing.assert_allclose(F[:3], np.cross(r, f).sum(axis=0), atol=1e-12)
        K = K.reshape(6, 6)
        np.testing.assert_allclose(K, K.T, atol=1e-9)
        assert np.linalg.eigvalsh(K).min() > -1e-9 * np.abs(K).max()
        assert not B.any()


def test_the_lever_of_the_stiffness() -> None:
    r = np.array([0.01, -0.02, 0.03])
    rig = FrictionRig(sled(r), [floor()], make_model())
    rig.state[6] = -r[2]
    rig.remember(rig.look())
    tick, h = rig.look(), 1e-8
    numeric = []
    for axis in range(6):
        ends = []
        for sign in (1, -1):
            rig.state = tick.state.copy()
            if axis < 3:
                turn = Rotation.from_rotvec(sign * h * np.eye(3)[axis]).as_quat()
                rig.state[:4] = np.roll(turn, 1)
            else:
                rig.state[axis + 1] += sign * h
            ends.append(rig.look().friction.wrench_model[:6])
        numeric.append((ends[0] - ends[1]) / (2 * h))
    K = tick.friction.wrench_model[6:42].reshape(6, 6)
    np.testing.assert_allclose(K, -np.transpose(numeric), rtol=1e-5, atol=1e-2)


def test_of_too_many_contacts_the_strongest_bear_all() -> None:
    tips = [[4e-3 * i, 4e-3 * j, 0] for i in range(6) for j in range(6)]
    rig = FrictionRig(sled(tips), [floor()], make_model())
    rig.remember(rig.look())
    rig.state[4] += 1e-3
    tick = rig.look()
    assert len(tick.clusters) == 36
    assert np.count_nonzero(tick.friction.f_cluster_W[:, 0]) == 32
    np.testing.assert_allclose(
        tick.friction_force, [-0.5 * tick.normal_force, 0, 0], atol=1e-9
    )


def test_an_object_without_friction_has_none() -> None:
    law = Law((0.0,), 1.2, 1e-4, 5e-3)
    rig = FrictionRig(sled([0, 0, 0]), [floor()], make_model(law))
    at(rig, 0, 0, 1.0)
    tick = at(rig, 1e-3, 0, 1.0)
    assert not tick.friction.wrench_model.any()
    assert not np.array(tick.friction.next_state)[7:].any()


def test_a_pose_that_is_no_number_is_forgotten() -> None:
    rig = one_foot()
    at(rig, 0, 0, 1.0)
    good = rig.look()
    bad = good.state[:7].copy()
    bad[4] = np.nan
    broken = make_model().step(rig.memory, good.clusters, good.wrench, bad, np.zeros(0))
    rig.memory = broken.next_state
    at(rig, 0, 0, 1.0)
    f = at(rig, 5e-5, 0, 1.0).friction_force
    np.testing.assert_allclose(f, [-0.3, 0, 0], atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"coefficient": [0.1, -0.2]}, r"coefficient\[1\].*at least 0.*-0.2"),
        ({"coefficient": [0.1, np.nan]}, r"coefficient\[1\]"),
        ({"coefficient": [0.1]}, "one item for each object"),
        ({"static_ratio": 0.9}, "static_ratio.*at least 1.*0.9"),
        ({"break_away_m": 0.0}, "break_away_m.*above 0.*0"),
        ({"reach_m": -1.0}, "reach_m.*above 0.*-1"),
    ],
)
def test_parameters_out_of_bounds_are_refused(
    change: dict[str, object], message: str
) -> None:
    arguments = {
        "coefficient": [0.1, 0.2],
        "moves": [False, False],
        "static_ratio": 1.2,
        "break_away_m": 1e-4,
        "reach_m": 5e-3,
    }
    with pytest.raises(ValueError, match=message):
        _core.StickSlipModel(**(arguments | change))


def test_sizes_that_do_not_match_are_refused() -> None:
    rig = one_foot()
    tick, other = (
        rig.look(),
        FrictionRig(sled([0, 0, 1]), [floor()], make_model()).look(),
    )
    q = tick.state[:7].copy()
    state, none = np.zeros(make_model().state_size), np.zeros(0)
    with pytest.raises(ValueError, match="state must have 391 numbers, has 3"):
        make_model().step(np.zeros(3), tick.clusters, tick.wrench, q, none)
    with pytest.raises(ValueError, match="q_WO must have 0 numbers, has 7"):
        make_model().step(state, tick.clusters, tick.wrench, q, np.zeros(7))
    with pytest.raises(ValueError, match="one force for each cluster"):
        make_model().step(state, tick.clusters, other.wrench, q, none)
    with pytest.raises(ValueError, match="no coefficient"):
        empty = _core.StickSlipModel([], [], 1.2, 1e-4, 5e-3)
        empty.step(state, tick.clusters, tick.wrench, q, none)
