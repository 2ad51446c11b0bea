"""Test stick-slip friction against its formulas in NumPy and against mechanics."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import IDENTITY, pose
from friction_bodies import burr, floor, sled
from friction_oracle import Law, Touch, matrix, step
from friction_rig import STIFFNESS_N_PER_M, TOLERANCE_M, FrictionRig, Tick
from scipy.spatial.transform import Rotation
from slide_rig import make_slide_tools
from slide_scenes import fifty_pieces, fifty_pieces_path

from drake_haptics import _core

LAW = Law((0.5,), 1.2, 1e-4, 5e-3)


def model(law: Law = LAW, moves: object = (False,)) -> _core.StickSlipModel:
    return _core.StickSlipModel(
        law.coefficient, moves, law.static_ratio, law.break_away_m, law.reach_m
    )


def one_foot(law: Law = LAW) -> FrictionRig:
    """A foot whose tip is the tool's origin, on a floor."""
    return FrictionRig(sled([0, 0, 0]), [floor()], model(law))


def at(rig: FrictionRig, x: float, y: float, normal_force_N: float) -> Tick:
    """Puts the foot's tip somewhere, under a force, and lets friction see it."""
    rig.state[4:7] = [x, y, TOLERANCE_M - normal_force_N / STIFFNESS_N_PER_M]
    tick = rig.look()
    rig.remember(tick)
    return tick


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
    rig = FrictionRig(tool, [still, moving], model(law, moves), moves=moves)
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


def test_a_drawn_foot_breaks_away_wears_and_slides_as_the_curve_says() -> None:
    rig, N = one_foot(), 2.0
    mu, r, b = LAW.coefficient[0], LAW.static_ratio, LAW.break_away_m
    at(rig, 0, 0, N)
    for x in np.linspace(0, 3 * b, 61)[1:]:
        f = at(rig, x, 0, N).friction_force
        # Up the spring, then down while slip s ≤ b wears the grip: x = b + s / r.
        expected = (
            mu * N * (r * x / b if x <= b else max(r - (x / b - 1) * r * (r - 1), 1))
        )
        np.testing.assert_allclose(f, [-expected, 0, 0], atol=1e-9)


def test_the_curve_does_not_depend_on_the_number_of_ticks() -> None:
    rigs = [one_foot() for _ in range(2)]
    for rig, ticks in zip(rigs, (3, 300), strict=True):
        for x in np.linspace(0, 1.4e-4, ticks):
            tick = at(rig, x, 0, 1.0)
        rig.force = tick.friction_force
    np.testing.assert_allclose(rigs[0].force, rigs[1].force, rtol=1e-9)


def test_a_relieved_foot_grips_again() -> None:
    rig, N, b = one_foot(), 2.0, LAW.break_away_m
    mu, r = LAW.coefficient[0], LAW.static_ratio
    stretch = b / r  # z while sliding
    at(rig, 0, 0, N)
    assert at(rig, 5 * b, 0, N).friction.sliding.all()
    for relief, grip in ((0.02, 0.2), (0.05, 0.5), (0.1, 1.0), (0.5, 1.0)):
        x = rig.state[4] - relief * stretch
        f = at(rig, x, 0, N).friction_force[0]
        assert f == pytest.approx(-mu * N * (1 - relief), abs=1e-9)
        # Drawn on until just before and just after it slips.
        limit = 1 + grip * (r - 1)
        at_limit = x + (relief + limit - 1) * stretch
        held = at(rig, at_limit - 1e-9, 0, N)
        assert not held.friction.sliding.any()
        assert -held.friction_force[0] == pytest.approx(limit * mu * N, rel=1e-4)
        assert at(rig, at_limit + 1e-9, 0, N).friction.sliding.all()
        at(rig, at_limit + 5 * b, 0, N)


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


def test_friction_follows_the_motion_when_it_turns() -> None:
    rig, N = one_foot(), 1.0
    for angle in np.linspace(0, 2 * np.pi, 2000):
        tick = at(rig, 0.02 * np.cos(angle), 0.02 * np.sin(angle), N)
    # The adhesion point follows on a tractrix: it lags by its distance over the
    # radius of the turn, and by the step of a tick.
    f = tick.friction_force
    lag = (LAW.break_away_m / LAW.static_ratio + 2 * np.pi * 0.02 / 1999) / 0.02
    np.testing.assert_allclose(f, [0, -0.5 * N, 0], atol=0.5 * N * lag)
    assert np.linalg.norm(f) == pytest.approx(0.5 * N)


@pytest.mark.parametrize("steps_m", [(4e-5,), (3e-4, 1e-4)], ids=["stick", "slide"])
def test_the_stiffness_is_the_derivative_of_the_force(
    steps_m: tuple[float, ...],
) -> None:
    # The tip is the tool's origin: the lever, which is frozen, has no length.
    rig = one_foot()
    at(rig, 0, 0, 2.0)
    for step_m in steps_m[:-1]:
        at(rig, rig.state[4] + step_m, 0, 2.0)
    rig.state[4] += steps_m[-1]
    tick, h = rig.look(), 1e-8
    numeric = []
    for axis in (4, 5):
        ends = []
        for sign in (1, -1):
            rig.state = tick.state.copy()
            rig.state[axis] += sign * h
            ends.append(rig.look().friction_force)
        numeric.append((ends[0] - ends[1]) / (2 * h))
    K = tick.friction.wrench_model[6:42].reshape(6, 6)
    np.testing.assert_allclose(K[3:, 3:5], -np.transpose(numeric), atol=1e-2)
    assert tick.friction.sliding[0] == (len(steps_m) > 1)
    assert K[4, 4] > 1e3


def test_the_lever_of_the_stiffness() -> None:
    r = np.array([0.01, -0.02, 0.03])
    rig = FrictionRig(sled(r), [floor()], model())
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


@pytest.mark.parametrize("seed", range(3))
def test_no_motion_under_any_force_makes_energy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rig = one_foot()
    x, N, work = np.zeros(2), 1.0, 0.0
    at(rig, 0, 0, N)
    for _ in range(3000):
        dx = rng.normal(size=2) * 10 ** rng.uniform(-6, -4)
        x = 0.999 * (x + dx)
        moved = x - rig.state[4:6]
        N = np.clip(N * np.exp(0.3 * rng.normal()), 1e-3, 10)
        work += at(rig, *x, N).friction_force[:2] @ moved
        assert work <= 1e-15
    assert work < -1e-4


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


def test_a_new_contact_starts_without_force() -> None:
    rig = one_foot()
    at(rig, 0, 0, 1.0)
    at(rig, 5e-5, 0, 1.0)
    rig.state[6] += 0.1
    rig.remember(rig.look())
    assert not at(rig, 5e-5, 0, 1.0).friction_force.any()


@pytest.mark.parametrize("name", ["box", "wide box", "ball", "spike", "edge"])
def test_sliding_over_seams_has_the_friction_of_one_face(name: str) -> None:
    rig = FrictionRig(make_slide_tools()[name], [fifty_pieces()], model())
    N, law = 1.0, LAW.coefficient[0]
    path = fifty_pieces_path(TOLERANCE_M - N / STIFFNESS_N_PER_M)
    direction = (path[-1] - path[0]) / np.linalg.norm(path[-1] - path[0])
    forces, counts = [], set()
    for p in path:
        rig.state[4:7] = p
        tick = rig.look()
        rig.remember(tick)
        assert tick.normal_force == pytest.approx(N, rel=1e-3)
        forces.append(tick.friction_force)
        counts.add(len(tick.clusters))
    assert len(counts) > 1
    away = np.array(forces[5:]) + law * N * direction
    assert np.linalg.norm(away, axis=1).max() < 0.01 * law * N


def test_contacts_that_merge_or_split_keep_the_sum_of_forces() -> None:
    """The paper's clusters of a foot pair: one or two by the leaf's size."""
    rig = FrictionRig(sled([[-1.5e-3, 0, 0], [1.5e-3, 0, 0]]), [floor()], model())
    at(rig, 0, 0, 1.0)
    before = at(rig, 3e-5, 4e-5, 1.0)
    assert len(before.clusters) == 2
    tracker = _core.SceneTracker(
        sled([[-1.5e-3, 0, 0], [1.5e-3, 0, 0]]), [floor()], TOLERANCE_M
    )
    contacts = tracker.query(rig.state[:7])
    merged = _core.cluster_contacts(contacts, 10e-3, TOLERANCE_M)
    assert len(merged) == 1
    none = (np.zeros((1, 3)), np.zeros((1, 6)))
    wrench = _core.penalty_force(
        merged,
        rig.state[4:7],
        np.zeros(6),
        *none,
        2 * np.full(1, STIFFNESS_N_PER_M),
        np.zeros(1),
    )
    one = model().step(rig._memory, merged, wrench, rig.state[:7].copy(), np.zeros(0))
    np.testing.assert_allclose(
        one.f_cluster_W.sum(axis=0), before.friction_force, rtol=0.01
    )
    rig._memory = one.next_state
    two = rig.look()
    np.testing.assert_allclose(two.friction_force, before.friction_force, rtol=0.02)


def test_of_too_many_contacts_the_strongest_bear_all() -> None:
    tips = [[4e-3 * i, 4e-3 * j, 0] for i in range(6) for j in range(6)]
    rig = FrictionRig(sled(tips), [floor()], model())
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
    rig = FrictionRig(sled([0, 0, 0]), [floor()], model(law))
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
    broken = model().step(rig._memory, good.clusters, good.wrench, bad, np.zeros(0))
    rig._memory = broken.next_state
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
    tick, other = rig.look(), FrictionRig(sled([0, 0, 1]), [floor()], model()).look()
    q = tick.state[:7].copy()
    state, none = np.zeros(model().state_size), np.zeros(0)
    with pytest.raises(ValueError, match="state must have 391 numbers, has 3"):
        model().step(np.zeros(3), tick.clusters, tick.wrench, q, none)
    with pytest.raises(ValueError, match="q_WO must have 0 numbers, has 7"):
        model().step(state, tick.clusters, tick.wrench, q, np.zeros(7))
    with pytest.raises(ValueError, match="one force for each cluster"):
        model().step(state, tick.clusters, other.wrench, q, none)
    with pytest.raises(ValueError, match="no coefficient"):
        empty = _core.StickSlipModel([], [], 1.2, 1e-4, 5e-3)
        empty.step(state, tick.clusters, tick.wrench, q, none)
