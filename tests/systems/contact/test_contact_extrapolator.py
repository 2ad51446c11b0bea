"""Contacts between two queries, against queries at every tick."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from autodiff_check import constant, seeded
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, over_a_plate
from contact_samples import IDENTITY, box, hull, pose, spike
from diagram_parts import EVERY, SYSTEMS, names, read_output, sources, unfed
from loop_gradients import calc_gradients, contact_states
from plant_scenes import PLANTS, PlantScene
from pydrake.geometry import Box
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.analysis import Simulator
from scipy.spatial.transform import Rotation

from drake_haptics import find_scene, load_scene
from drake_haptics._core import (
    AutoDiffVector,
    ContactExtrapolation,
    ContactSet,
    ConvexPieces,
    SceneTracker,
    differentiate_contacts,
)
from drake_haptics.analysis.diagram_systems import find_state_layout
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.scene.schema import ContactParameters, Effects
from drake_haptics.simulation.run import run
from drake_haptics.systems.contact.pose_sampler import PoseSampler

T = 2e-3
SLAB = box((0.2, 0.2, 0.02), (0, 0, -0.01))  # its top is z = 0
BETWEEN = {"pose_sampler", "contact_extrapolator"}


def turned(p: object, turn: object) -> np.ndarray:
    return pose(p, np.roll(Rotation.from_rotvec(turn).as_quat(), 1))


def query(
    tool: ConvexPieces, objects: list[ConvexPieces], poses: np.ndarray
) -> ContactSet:
    """The contacts at poses (7 + 7 m,) of the tool and of all objects."""
    tracker = SceneTracker(tool, objects, T)
    for i in range(len(objects)):
        tracker.set_object_pose(i, poses[7 * (i + 1) : 7 * (i + 2)])
    return tracker.query(poses[:7])


def test_a_tip_over_a_plane_that_moves_is_carried_exactly() -> None:
    """Whichever body the plane is of."""
    tip, plane = spike([0, 0, 0]), SLAB
    found = np.concatenate([turned([0.01, 0, -1e-3], [0, 0.1, 0]), IDENTITY])
    now = np.concatenate(
        [
            turned([0.013, 2e-3, 4e-3], [0.1, 0.2, 0.3]),
            turned([1e-3, -1e-3, 5e-3], [0.05, -0.04, 0.2]),
        ]
    )
    for order in (slice(None), slice(None, None, -1)):
        bodies = [tip, plane][order]
        at = [poses.reshape(2, 7)[order].ravel() for poses in (found, now)]
        carrier = ContactExtrapolation(bodies[0], bodies[1:], [None])
        carried = carrier.advance(query(bodies[0], bodies[1:], at[0]), *at)
        expected = query(bodies[0], bodies[1:], at[1])
        assert len(carried) == len(expected) == 1
        np.testing.assert_allclose(carried.distance, expected.distance, atol=1e-12)
        np.testing.assert_allclose(carried.nhat_BA_W, expected.nhat_BA_W, atol=1e-12)
        for name in ("p_WCa", "p_WCb", "p_WC"):
            np.testing.assert_allclose(
                getattr(carried, name), getattr(expected, name), atol=1e-12
            )


CORNER_M = 0.01 * np.sqrt(3)  # of a cube of 20 mm, from its center
GAP_M = 1e-3
FAR = np.array([1.0, 2.0, 3.0])


def corner_pose(up: float, height_m: float) -> np.ndarray:
    """A cube of 20 mm with one corner on the z axis, the others above or below it."""
    R, _ = Rotation.align_vectors([[0, 0, up]], [np.ones(3) / np.sqrt(3)])
    return turned([0, 0, height_m - up * CORNER_M], R.as_rotvec())


EDGE_POSE = turned(
    [0, 0, -0.01 * np.sqrt(2)], [np.pi / 4, 0, 0]
)  # its edge is y = z = 0


@pytest.mark.parametrize("is_swapped", [False, True])
@pytest.mark.parametrize(
    "below", [corner_pose(1, 0), EDGE_POSE], ids=["corner", "edge"]
)
def test_a_normal_between_closest_points_turns_as_the_query_says(
    below: np.ndarray, is_swapped: bool
) -> None:
    """Of a corner near a corner or an edge: exactly sideways, else to first order."""
    cube = box((0.02, 0.02, 0.02))
    order = slice(None, None, -1) if is_swapped else slice(None)

    def at(shift: object) -> np.ndarray:
        above = corner_pose(-1, GAP_M)
        above[4:] += shift
        # All of it turned and far away.
        R = Rotation.from_rotvec([0.3, -0.2, 0.1])
        poses = []
        for q in (above, below):
            R_WB = R * Rotation.from_quat(np.roll(q[:4], -1))
            poses.append(turned(FAR + R.apply(q[4:]), R_WB.as_rotvec()))
        return np.concatenate(poses[order])

    carrier = ContactExtrapolation(cube, [cube], [None])
    contacts = query(cube, [cube], at([0, 0, 0]))
    assert len(contacts) == 1
    kinds = {contacts.feature_A[0, 0], contacts.feature_B[0, 0]}
    assert kinds == ({0} if below is not EDGE_POSE else {0, 1})

    def errors(shift: object) -> np.ndarray:
        carried = carrier.advance(contacts, at([0, 0, 0]), at(shift))
        true = query(cube, [cube], at(shift))
        return np.array(
            [
                np.abs(getattr(carried, name) - getattr(true, name)).max()
                for name in ("distance", "nhat_BA_W", "p_WC")
            ]
        )

    assert errors([0.01 * GAP_M, 0.1 * GAP_M, 0])[1] < 1e-10
    steps = [errors([0.2 * s, s, -s]) for s in (0.01 * GAP_M, 0.02 * GAP_M)]
    assert steps[1][1] == pytest.approx(4 * steps[0][1], rel=0.1)
    assert (steps[1] < [1e-8, 1e-3, 1e-6]).all()
    # Past each other the normal stays: the one is pushed back out of the other.
    through = carrier.advance(contacts, at([0, 0, 0]), at([0, 0, -2 * GAP_M]))
    np.testing.assert_allclose(through.nhat_BA_W, contacts.nhat_BA_W, atol=1e-9)
    np.testing.assert_allclose(through.distance, -GAP_M, atol=1e-9)


def test_a_ball_that_rolls_is_wrong_by_the_square_of_its_motion() -> None:
    radius = 0.01
    ball = hull(trimesh.creation.icosphere(subdivisions=5, radius=radius).vertices)
    found = pose([0, 0, radius - 5e-4])
    contacts = query(ball, [SLAB], np.concatenate([found, IDENTITY]))
    carrier = ContactExtrapolation(ball, [SLAB], [IDENTITY])
    errors = []
    for angle in (0.1, 0.2, 0.4):
        now = turned([radius * angle, 0, radius - 5e-4], [0, angle, 0])
        (distance,) = carrier.advance(contacts, found, now).distance
        errors.append(distance + 5e-4)
        # The point that touched has come up by r (1 - cos).
        assert errors[-1] == pytest.approx(radius * (1 - np.cos(angle)), abs=2e-6)
    np.testing.assert_allclose(np.divide(errors[1:], errors[:-1]), 4, rtol=0.05)


def test_the_rate_of_the_distance_is_that_of_the_query() -> None:
    """To first order nothing is lost, whatever the features."""
    rng = np.random.default_rng(0)
    tool = box((0.02, 0.02, 0.02))
    compared = 0
    for _ in range(40):
        q_WA = turned([0, 0, 0.0165], rng.normal(size=3))
        q_WB = turned([0.004, 0.003, -0.007], 0.4 * rng.normal(size=3))
        found = np.concatenate([q_WA, q_WB])
        other = box((0.03, 0.03, 0.03), (0, 0, -0.008))
        contacts = query(tool, [other], found)
        if not len(contacts):
            continue
        compared += 1
        carrier = ContactExtrapolation(tool, [other], [None])
        now = seeded(found)
        true = differentiate_contacts(
            contacts, T, tool, *(_part(now, 0), [other], [_part(now, 1)])
        )
        still = differentiate_contacts(
            contacts, T, tool, constant(q_WA, 14), [other], [constant(q_WB, 14)]
        )
        carried = carrier.advance(still, constant(found, 14), now)
        np.testing.assert_allclose(
            carried.distance.gradient, true.distance.gradient, atol=1e-9
        )
        np.testing.assert_allclose(
            carried.nhat_BA_W.gradient, true.nhat_BA_W.gradient, atol=1e-6
        )
        # And those of all else that is carried are those of doubles.
        step = 1e-6
        for k in range(14):
            d = step * np.eye(14)[k]
            ahead, behind = (
                carrier.advance(contacts, found, found + x) for x in (d, -d)
            )
            for name in ("distance", "nhat_BA_W", "p_WCa", "p_WCb", "p_WC"):
                slope = (getattr(ahead, name) - getattr(behind, name)) / (2 * step)
                np.testing.assert_allclose(
                    getattr(carried, name).gradient[:, k], slope.ravel(), atol=1e-8
                )
    assert compared > 20


def _part(vector: AutoDiffVector, i: int) -> AutoDiffVector:
    rows = slice(7 * i, 7 * i + 7)
    return AutoDiffVector(vector.value[rows], vector.gradient[rows])


def test_poses_that_are_none_are_refused() -> None:
    contacts = query(spike([0, 0, 0]), [SLAB], np.tile(IDENTITY, 2))
    tool, moving = (
        spike([0, 0, 0]),
        ContactExtrapolation(spike([0, 0, 0]), [SLAB], [None]),
    )
    with pytest.raises(ValueError, match="found and now must have 7 numbers"):
        moving.advance(contacts, IDENTITY, IDENTITY)
    with pytest.raises(ValueError, match="now"):
        ContactExtrapolation(tool, [SLAB], [IDENTITY]).advance(
            contacts, IDENTITY, np.full(7, np.nan)
        )
    with pytest.raises(ValueError, match="X_WO must have one entry for each"):
        ContactExtrapolation(tool, [SLAB], [])
    with pytest.raises(IndexError, match="must have the same objects"):
        ContactExtrapolation(tool, [], []).advance(contacts, IDENTITY, IDENTITY)


def test_a_sampler_names_its_state_and_checks_its_period() -> None:
    names = PoseSampler(["b"], 4e-3).list_state_names()
    assert names[:1] == ["X_WT.qw"] and len(names) == 14
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        PoseSampler([], 0.0)


def pressing(tmp_path, rate_hz: float | None, **effects):
    """A scene of a cube that is pressed on a plate and drawn along."""
    down = TOOL_HALF_HEIGHT - 2e-3
    scene = over_a_plate(
        tmp_path, [(0, 0, 0, down + 4e-3), (0.2, 0, 0, down), (0.6, 0.03, 0, down)]
    )
    scene.effects = Effects(**effects)
    scene.contact.query_rate_hz = rate_hz
    return scene


def test_the_systems_are_there_only_where_the_rate_is_given(tmp_path) -> None:
    assert names(BuildHapticDiagram(pressing(tmp_path, None)).diagram) == SYSTEMS
    haptic = BuildHapticDiagram(pressing(tmp_path, 250.0, **EVERY))
    assert BETWEEN <= names(haptic.diagram)
    fed = sources(haptic.diagram)
    # The coupling is part of no chain here.
    assert unfed(haptic.diagram) == {"device.coupled_motions"}
    assert fed["contact_query.X_WT"] == "pose_sampler.X_WT"
    assert fed["contact_extrapolator.found_X_WT"] == "pose_sampler.X_WT"
    assert fed["contact_extrapolator.X_WT"] == "haptic_tool.X_WT"
    assert fed["force_shading.contacts"] == "contact_extrapolator.contacts"
    assert fed["contact_clustering.contacts"] == "force_shading.contacts"


def test_contacts_are_looked_for_every_fourth_tick_and_carried_between(
    tmp_path,
) -> None:
    haptic = BuildHapticDiagram(pressing(tmp_path, 250.0))
    loop = haptic.loop
    asked: list[int] = []
    heights: list[float] = []

    def look(root) -> None:
        found = read_output(loop.contact_query, "contacts", root)
        asked.append(id(found))
        kept.append(found)
        now = read_output(loop.contact_extrapolator, "contacts", root)
        z = read_output(loop.haptic_tool, "X_WT", root)[6]
        heights.append(z)
        if len(now):
            # A face stays flat on a face here: the distance is known.
            assert now.distance.min() == pytest.approx(
                z - TOOL_HALF_HEIGHT - PLATE_TOP, abs=2e-5
            )

    kept: list[ContactSet] = []
    run(haptic, 0.4, on_tick=look)
    assert len(asked) == 400 and len(set(asked)) == pytest.approx(100, abs=1)
    assert min(heights) < TOOL_HALF_HEIGHT + PLATE_TOP + T


@pytest.fixture(scope="module")
def cup_spoon() -> dict[float | None, tuple[HapticDiagram, np.ndarray, float]]:
    """Cup and spoon, their contacts looked for at 250 Hz and at each tick."""
    results = {}
    for rate_hz in (None, 250.0):
        scene = load_scene(find_scene("cup_spoon"))
        scene.contact = replace(scene.contact, query_rate_hz=rate_hz)
        haptic = BuildHapticDiagram(scene)
        results[rate_hz] = (haptic, *watch(haptic))
    return results


def watch(haptic: HapticDiagram) -> tuple[np.ndarray, float]:
    """Returns the tool's poses (n, 7), and how much less deep than by a query it was.

    That is the most by which the contacts near one that a query finds are less deep,
    m: a pair of pieces may have handed its contact over to the next. Looked at every
    third tick, so at contacts of every age.
    """
    loop = haptic.loop
    tracker = SceneTracker(
        haptic.tool.core,
        [item.core for item in haptic.environment],
        haptic.scene.contact.tolerance_m,
    )
    for i, item in enumerate(haptic.scene.environment):
        tracker.set_object_pose(i, item.pose.to_rigid_transform())
    poses: list[np.ndarray] = []
    missed = 0.0

    def look(root) -> None:
        nonlocal missed
        poses.append(np.array(read_output(loop.haptic_tool, "X_WT", root)))
        if loop.contact_extrapolator is None or len(poses) % 3:
            return
        now = read_output(loop.contact_extrapolator, "contacts", root)
        true = tracker.query(poses[-1])
        apart = np.linalg.norm(true.p_WC[:, None] - now.p_WC[None], axis=2)
        is_near = (apart < 5e-3) & (true.nhat_BA_W @ now.nhat_BA_W.T > 0.5)
        nearest = np.where(is_near, now.distance, 0.0).min(axis=1, initial=0.0)
        missed = max(missed, (nearest - true.distance).max(initial=0.0))

    run(haptic, 2.0, on_tick=look)
    return np.array(poses), missed


def test_a_loop_that_looks_for_contacts_at_250_hz_is_stable(cup_spoon) -> None:
    """It goes the way of the loop that looks at each tick, and does not shake."""
    slow, fast = cup_spoon[250.0][1], cup_spoon[None][1]
    assert len(slow) == len(fast) == 2000
    assert np.abs(slow[:, 4:] - fast[:, 4:]).max() < 1e-3
    jerk = [np.abs(np.diff(p[:, 4:], 2, axis=0)).max() for p in (slow, fast)]
    assert jerk[0] < 3 * jerk[1]


def test_no_contact_in_depth_is_lost_between_two_queries(cup_spoon) -> None:
    """Near each that a query would find there is one, as deep to some µm."""
    assert cup_spoon[250.0][2] < 1e-5


def test_bodies_of_a_plant_that_move_are_followed_between_queries() -> None:
    """A cube on a free plate in free fall together: they rest against each other."""
    heights = []
    for rate_hz in (None, 200.0):
        scene = PlantScene(PLANTS["sampled"])
        scene.add("tool", Box(0.04, 0.04, 0.04), mass=0.1)
        scene.add("plate", Box(0.2, 0.2, 0.02), mass=0.5)
        scene.finalize()
        rendering = scene.render(
            contact=ContactParameters(
                stiffness_N_per_m=500.0, damping_Ns_per_m=2.0, query_rate_hz=rate_hz
            ),
            effects=Effects(friction=EVERY["friction"], braking=EVERY["braking"]),
        )
        assert (names(rendering) >= BETWEEN) == (rate_hz is not None)
        tilt = RollPitchYaw(0.0, 0.3, 0.0)
        scene.start(
            tool=RigidTransform(tilt, [0, 0, 5.0 + 0.03]),
            plate=RigidTransform([0, 0, 5.0 - 0.005]),
        )
        scene.simulator.AdvanceTo(0.3)
        heights.append(
            scene.pose("tool").translation() - scene.pose("plate").translation()
        )
    assert heights[0][2] > 0.02
    np.testing.assert_allclose(heights[1], heights[0], atol=1e-3)


def test_a_sample_begins_where_the_tool_is(tmp_path) -> None:
    """Also where somebody has moved it before the start."""
    haptic = BuildHapticDiagram(pressing(tmp_path, 250.0))
    simulator = Simulator(haptic.diagram)
    root = simulator.get_mutable_context()
    tool = haptic.loop.haptic_tool
    X_WT = pose_to_vector(RigidTransform([0.01, 0.02, 0.03]))
    state = tool.GetMyMutableContextFromRoot(root).get_mutable_discrete_state_vector()
    value = np.array(state.value())
    value[:7] = X_WT
    state.SetFromVector(value)
    simulator.Initialize()
    held = read_output(haptic.loop.pose_sampler, "X_WT", root)
    np.testing.assert_array_equal(held, X_WT)


def test_derivatives_of_a_loop_with_carried_contacts_are_those_of_doubles() -> None:
    scene = load_scene(find_scene("cup_spoon"))
    scene.contact = replace(scene.contact, query_rate_hz=250.0)
    haptic = BuildHapticDiagram(scene)
    names = find_state_layout(haptic.diagram).names
    held = [i for i, name in enumerate(names) if "pose_sampler" in name]
    assert len(held) == 7
    (context,) = contact_states(haptic, 1, 0.8)
    gradients = calc_gradients(haptic, context)
    assert np.nanmax(gradients.errors) < 1e-6
    # The tool moves by where the contacts were found, too.
    tool = [i for i, name in enumerate(names) if "haptic_tool" in name]
    assert np.abs(gradients.found[np.ix_(tool, held)]).max() > 1e-6
