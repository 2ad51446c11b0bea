"""Test the braking before contact against its plain NumPy form and closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from contact_samples import box, hull, pose

from drake_haptics import _core

B, D = 8.0, 4e-3
RHO = 0.1
GAINS = _core.BrakingGains(B, D)
SLAB = box([0.1, 0.1, 0.01], [0, 0, -0.005])
AT_REST = np.zeros(6)
UP, DOWN = np.eye(6)[5], -np.eye(6)[5]


def make_ball() -> _core.ConvexPieces:
    """Many vertices on a sphere of 20 mm."""
    points = np.random.default_rng(0).normal(size=(150, 3))
    return hull(0.02 * points / np.linalg.norm(points, axis=1)[:, None])


BALL = make_ball()


def slabs_around(normals: Sequence[object], gaps: Sequence[float]) -> _core.ContactSet:
    """Contacts of a ball with slabs about it, whose faces look along the normals."""
    tracker = _core.SceneTracker(BALL, [SLAB] * len(normals), 2 * D)
    for i, (normal, gap) in enumerate(zip(normals, gaps, strict=True)):
        n = np.asarray(normal, float) / np.linalg.norm(normal)
        # The face is z = 0 of the slab, put below the ball's outermost vertex.
        q = np.array([1 + n[2], -n[1], n[0], 0])
        reach = max(BALL.vertices @ -n)
        tracker.set_object_pose(i, pose(-(reach + gap) * n, q / np.linalg.norm(q)))
    return tracker.query(pose([0, 0, 0]))


def brake(
    contacts: _core.ContactSet,
    V: np.ndarray,
    V_O: np.ndarray | None = None,
    gains: _core.BrakingGains = GAINS,
    p_WTo: object = (0, 0, 0),
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the wrench (6,) and the damping (6, 6)."""
    count = 1 + max(contacts.object_index, default=0)
    V_O = np.zeros((count, 6)) if V_O is None else V_O
    objects = _core.ObjectFrames(np.zeros((count, 3)), V_O)
    model = _core.pre_contact_braking(
        contacts, np.asarray(p_WTo, float), V, objects, gains
    )
    assert not model[6:42].any()
    return model[:6], model[42:78].reshape(6, 6)


def plain(
    contacts: _core.ContactSet, p_WTo: np.ndarray, V: np.ndarray, V_O: np.ndarray
) -> np.ndarray:
    """The braking, pair by pair, written down."""
    F = np.zeros(6)
    near = contacts.distance / D
    w = np.where((near > 0) & (near < 1), 4 * near * (1 - near), 0.0)
    n = contacts.nhat_BA_W
    m = np.column_stack([np.ones(len(n)), n]) / np.sqrt(2)
    everyone = m.T @ np.diag(w**2) @ m
    for i, p in enumerate(contacts.p_WC):
        velocity = V[3:] + np.cross(V[:3], p - p_WTo)
        other = V_O[contacts.object_index[i]]
        velocity = velocity - other[3:] - np.cross(other[:3], p)
        approach = max(0.0, -velocity @ n[i])
        if w[i] > 0:
            ridge = RHO * w[i] ** 2
            leverage = m[i] @ np.linalg.solve(everyone + ridge * np.eye(4), m[i])
            share = (1 + RHO) * w[i] ** 2 * leverage
            f = B * w[i] * share * approach * n[i]
            F += np.concatenate([np.cross(p - p_WTo, f), f])
    return F


@pytest.mark.parametrize("seed", range(10))
def test_the_wrench_agrees_with_the_formula(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = 7
    contacts = slabs_around(
        rng.normal(size=(count, 3)), rng.uniform(-0.2 * D, 1.2 * D, count)
    )
    assert len(contacts) == count
    p_WTo, V = rng.normal(size=3), rng.normal(size=6)
    V_O = rng.normal(size=(count, 6))
    F, _ = brake(contacts, V, V_O, p_WTo=p_WTo)
    np.testing.assert_allclose(F, plain(contacts, p_WTo, V, V_O), atol=1e-12)
    assert np.linalg.norm(F) > 0.1


@pytest.mark.parametrize("seed", range(5))
def test_each_object_gets_the_reaction_of_its_own_contacts(seed: int) -> None:
    """Of each object alone, the tool gets the opposite about the same point."""
    rng = np.random.default_rng(seed)
    count = 5
    contacts = slabs_around(rng.normal(size=(count, 3)), rng.uniform(0, D, count))
    p_WTo, p_WO = rng.normal(size=3), rng.normal(size=(count, 3))
    V = rng.normal(size=6)

    def wrenches(V_O: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        objects = _core.ObjectFrames(p_WO, V_O)
        all_of_them = _core.pre_contact_braking(contacts, p_WTo, V, objects, GAINS)
        return all_of_them[:6], all_of_them[78:].reshape(count, 6)

    def about_origin(F: np.ndarray, p: np.ndarray) -> np.ndarray:
        return np.concatenate([F[:3] + np.cross(p, F[3:]), F[3:]])

    # An object that flees along its normals is not braked.
    for i in range(count):
        V_O = np.zeros((count, 6))
        V_O[:, 3:] = -100.0 * contacts.nhat_BA_W[np.argsort(contacts.object_index)]
        V_O[i] = rng.normal(size=6) - V_O[i]
        F, F_O = wrenches(V_O)
        assert np.linalg.norm(F) > 0.1
        np.testing.assert_allclose(
            about_origin(F_O[i], p_WO[i]), -about_origin(F, p_WTo), atol=1e-9
        )
        assert not np.delete(F_O, i, axis=0).any()


@pytest.mark.parametrize("near", [-0.1, 0.0, 0.01, 0.25, 0.5, 0.9, 0.99, 1.0, 1.1])
def test_one_contact_is_braked_by_the_profile(near: float) -> None:
    contacts = slabs_around([[0, 0, 1]], [near * D])
    expected = B * max(0.0, 4 * near * (1 - near))
    F, damping = brake(contacts, 0.3 * DOWN)
    np.testing.assert_allclose(F[5], 0.3 * expected, atol=1e-9)
    assert damping[5, 5] == pytest.approx(expected, abs=1e-9)


def test_what_leaves_or_slides_is_not_held_back() -> None:
    contacts = slabs_around([[0, 0, 1]], [0.3 * D])
    F, damping = brake(contacts, 0.3 * UP)
    assert not F.any()
    assert not damping.any()
    _, of_approach = brake(contacts, 0.3 * DOWN)
    for V in (np.eye(6)[3], AT_REST):
        F, damping = brake(contacts, V)
        assert not F.any()
        # Half of every small motion from here is an approach.
        np.testing.assert_allclose(damping, of_approach / 2, atol=1e-15)


def test_only_the_motion_between_the_two_counts() -> None:
    contacts = slabs_around([[0, 0, 1]], [0.5 * D])
    F, _ = brake(contacts, 0.2 * DOWN, 0.2 * DOWN[None])
    np.testing.assert_allclose(F, 0.0, atol=1e-15)
    F, _ = brake(contacts, AT_REST, 0.2 * UP[None])
    assert F[5] == pytest.approx(0.2 * B)


@pytest.mark.parametrize("copies", [2, 10, 100])
def test_a_contact_cut_into_copies_brakes_hardly_more(copies: int) -> None:
    one, _ = brake(slabs_around([[0, 0, 1]], [0.4 * D]), DOWN)
    cut, _ = brake(slabs_around([[0, 0, 1]] * copies, [0.4 * D] * copies), DOWN)
    assert cut[5] == pytest.approx(one[5] * (1 + RHO) / (1 + RHO / copies))
    assert one[5] < cut[5] < (1 + RHO) * one[5]


@pytest.mark.parametrize("copies", [1, 10, 1000])
def test_a_floor_of_many_pieces_leaves_a_wall_its_braking(copies: int) -> None:
    gaps = [0.4 * D] + [0.5 * D] * copies
    alone, _ = brake(slabs_around([[1, 0, 0]], gaps[:1]), -np.eye(6)[3])
    beside, _ = brake(
        slabs_around([[1, 0, 0], *[[0, 0, 1]] * copies], gaps), -np.eye(6)[3]
    )
    assert 0.95 * alone[3] < beside[3] < 1.05 * alone[3]


def test_like_normals_together_have_hardly_more_than_the_damping_of_one() -> None:
    rng = np.random.default_rng(2)
    for _ in range(20):
        count = rng.integers(1, 30)
        contacts = slabs_around([[0, 0, 1]] * count, rng.uniform(0, D, count))
        _, damping = brake(contacts, DOWN)
        assert 0 < damping[5, 5] <= (1 + RHO) * B


def test_the_damping_is_bounded_whatever_the_normals() -> None:
    """By 4.4 b in all; both signs of a velocity together reach every contact."""
    rng = np.random.default_rng(3)
    largest = 0.0
    for _ in range(40):
        count = rng.integers(1, 40)
        normals = rng.normal(size=(count, 3)) * rng.uniform(0, 1, size=3)
        contacts = slabs_around(normals, rng.uniform(0.3, 0.7, count) * D)
        direction = np.concatenate([np.zeros(3), rng.normal(size=3)])
        both = brake(contacts, direction)[1] + brake(contacts, -direction)[1]
        largest = max(largest, np.trace(both[3:, 3:]))
    assert B < largest <= 4 * (1 + RHO) * B


def test_opposite_walls_share_nothing() -> None:
    one, _ = brake(slabs_around([[1, 0, 0]], [0.5 * D]), -np.eye(6)[3])
    slot = slabs_around([[1, 0, 0], [-1, 0, 0]], [0.5 * D, 0.5 * D])
    both, _ = brake(slot, -np.eye(6)[3])
    assert both[3] == pytest.approx(one[3])


def test_the_wrench_is_continuous_in_the_pose() -> None:
    """Through first sight, full braking and touch of several surfaces at once."""
    normals = [[0, 0, 1], [0.1, 0, 1], [0.5, 0.5, 1], [1, 0, 0], [0, 0, 1.0]]
    offsets = np.array([0.0, 1e-4, 8e-4, 1e-3, 2e-3])
    V = np.array([0.5, -0.3, 0.2, -0.2, -0.1, -0.3])
    way = np.linspace(1.3 * D, -0.6 * D, 4001)
    F = np.array([brake(slabs_around(normals, offsets + x), V)[0] for x in way])
    step = way[0] - way[1]
    slope = np.abs(np.diff(F, axis=0)).max() / step
    # The profile's slope is 4/D; sharing can add to that of a contact.
    speed = np.linalg.norm(V[3:]) + 0.02 * np.linalg.norm(V[:3])
    assert slope < 2 * B * speed * 4 / D
    assert np.abs(F).max() > 0.5 * B * np.linalg.norm(V[3:])


def test_the_wrench_is_continuous_in_the_velocity() -> None:
    contacts = slabs_around([[0, 0, 1], [0, 1, 1], [1, 0, 0.2]], [1e-3, 2e-3, 3e-3])
    rng = np.random.default_rng(5)
    a, b = rng.normal(size=(2, 6))
    F = np.array([brake(contacts, a + s * (b - a))[0] for s in np.linspace(0, 1, 2001)])
    assert np.abs(np.diff(F, axis=0)).max() < 2 * B * np.linalg.norm(b - a) / 2000


def test_the_damping_is_the_derivative_and_takes_energy() -> None:
    rng = np.random.default_rng(6)
    contacts = slabs_around(rng.normal(size=(6, 3)), rng.uniform(0, D, 6))
    p_WTo = np.array([0.01, -0.02, 0.03])
    for _ in range(20):
        V = rng.normal(size=6)
        F, damping = brake(contacts, V, p_WTo=p_WTo)
        numeric = np.column_stack(
            [
                brake(contacts, V - 1e-6 * e, p_WTo=p_WTo)[0]
                - brake(contacts, V + 1e-6 * e, p_WTo=p_WTo)[0]
                for e in np.eye(6)
            ]
        )
        np.testing.assert_allclose(damping, numeric / 2e-6, atol=1e-7)
        np.testing.assert_allclose(F, -damping @ V, atol=1e-12)
        assert np.linalg.eigvalsh(damping).min() > -1e-12
        assert V @ F <= 0


def test_no_contacts_no_wrench() -> None:
    F, damping = brake(slabs_around([[0, 0, 1]], [3 * D]), DOWN)
    assert not F.any()
    assert not damping.any()


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("damping_Ns_per_m", -1.0),
        ("damping_Ns_per_m", np.nan),
        ("damping_Ns_per_m", np.inf),
        ("distance_m", 0.0),
        ("distance_m", -1e-3),
        ("distance_m", np.nan),
        ("distance_m", np.inf),
    ],
)
def test_gains_are_checked_by_name(name: str, bad: float) -> None:
    good = {"damping_Ns_per_m": B, "distance_m": D}
    with pytest.raises(ValueError, match=f"{name} must be finite and .*, is {bad:g}"):
        _core.BrakingGains(**good | {name: bad})


def test_objects_are_checked() -> None:
    contacts = slabs_around([[0, 0, 1]], [0.5 * D])
    none = _core.ObjectFrames(np.zeros((0, 3)), np.zeros((0, 6)))
    with pytest.raises(IndexError):
        _core.pre_contact_braking(contacts, np.zeros(3), DOWN, none, GAINS)
