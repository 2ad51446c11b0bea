"""What a tracker finds where an overlap begins within one step, or was there first.

A tool that was 0.2 mm in front of a solid and is 0.3 mm inside after one step of
0.5 mm has passed the skin between two queries. It must be met as if it had come slowly.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from contact_samples import IDENTITY, box, pose
from mesh_samples import REAL_MESHES, tray
from plant_scenes import G, PlantScene
from press_tools import MODELS, hull_mesh
from pydrake.geometry import Box
from pydrake.geometry import Mesh as MeshShape
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from scipy.spatial.transform import Rotation
from solid_surface import Overlap, Surface

from drake_haptics import ContactTracker, SceneTracker, decompose, load_mesh
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.scene.schema import ContactParameters

TILTS = [0.0, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3]
FLOOR_M = 0.003
OUT_M, IN_M = 2e-4, 3e-4
SHIPPED = sorted(path.stem for path in MODELS.glob("*.obj"))
REAL = (
    "socket_round_8mm.npz",
    "peg_round_8mm.npz",
    "mug.stl",
    "gear_base.obj",
    "gear_small.npz",
    "cup_500.obj",
    "torus_2000.obj",
    "hammer_1692.obj",
)


def box_mesh(size, at=(0.0, 0.0, 0.0)):
    corners = np.array(list(product((-0.5, 0.5), repeat=3)))
    return hull_mesh(corners * np.array(size) + np.array(at))


@pytest.fixture(scope="module")
def box_and_tray():
    tool = box_mesh([0.006, 0.006, 0.03], [0, 0, 0.015])
    solid = Mesh.from_arrays(*tray(floor=FLOOR_M))
    return decompose(tool, cache=False), decompose(solid, cache=False)


def above_floor(height_m, tilt_rad):
    """The box's frame so high above the floor, tilted about x."""
    X = np.eye(4)
    X[:3, :3] = Rotation.from_rotvec([tilt_rad, 0, 0]).as_matrix()
    X[2, 3] = FLOOR_M + height_m
    return X


def assert_on_floor(contacts, height_m, tilt_rad):
    """The floor alone is met, as deep as the box's lowest corner is below it."""
    assert len(contacts) > 0
    depth_m = -height_m + 0.003 * np.sin(tilt_rad)
    np.testing.assert_allclose(contacts.distance, -depth_m, atol=1e-9)
    np.testing.assert_allclose(
        contacts.nhat_BA_W, np.tile([0, 0, 1], (len(contacts), 1)), atol=2e-3
    )


@pytest.mark.parametrize("depth", ["tracked", "global"])
@pytest.mark.parametrize("tolerance_m", [0.0, 1e-5, 1e-4])
@pytest.mark.parametrize("tilt_rad", TILTS)
def test_the_floor_of_a_tray_is_met(box_and_tray, tilt_rad, tolerance_m, depth):
    tool, solid = box_and_tray
    tracker = SceneTracker(tool, [solid], tolerance_m, depth=depth)
    assert_on_floor(tracker.query(above_floor(-1e-4, tilt_rad)), -1e-4, tilt_rad)
    tracker = SceneTracker(tool, [solid], tolerance_m, depth=depth)
    assert len(tracker.query(above_floor(OUT_M, tilt_rad))) == 0
    for height_m in (-1e-4, -1e-4, -2e-4, -5e-4, -1e-3, -2e-3, -2e-3):
        contacts = tracker.query(above_floor(height_m, tilt_rad))
        assert_on_floor(contacts, height_m, tilt_rad)


@pytest.mark.parametrize("speed_m_per_s", [0.001, 0.1, 0.3])
@pytest.mark.parametrize("tolerance_m", [0.0, 1e-5, 1e-4])
def test_the_floor_holds_at_any_speed(box_and_tray, tolerance_m, speed_m_per_s):
    tool, solid = box_and_tray
    tracker = SceneTracker(tool, [solid], tolerance_m)
    for height_m in np.arange(3.3e-4, -2e-3, -1e-3 * speed_m_per_s):
        contacts = tracker.query(above_floor(height_m, 1e-4))
        if height_m < -1e-6:
            assert_on_floor(contacts, height_m, 1e-4)


def draw_landings(mesh, overlap, count):
    """Poses (7,) in front of a solid and in it, one step apart along a normal."""
    corners = mesh.vertices[mesh.triangles]
    vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(vectors, axis=1)
    rng = np.random.default_rng(0)
    landings = []
    for _ in range(20 * count):
        t = rng.choice(len(areas), p=areas / areas.sum())
        n = vectors[t] / areas[t]
        p = rng.dirichlet(np.ones(3)) @ corners[t]
        x, y, z, w = Rotation.random(random_state=rng.integers(1 << 31)).as_quat()

        def at(height_m, q=(w, x, y, z), p=p, n=n):
            return np.concatenate([q, p + height_m * n])

        free_m, deep_m = 8e-3, -3e-3
        if overlap(at(free_m)):
            continue
        deep_m = next(
            (h for h in np.arange(free_m, deep_m, -3e-4) if overlap.crosses(at(h))),
            None,
        )
        if deep_m is None:
            continue
        free_m = deep_m + 3e-4
        for _ in range(20):
            middle_m = (free_m + deep_m) / 2
            if overlap.crosses(at(middle_m)):
                deep_m = middle_m
            else:
                free_m = middle_m
        before, now = at(free_m + OUT_M), at(free_m - IN_M)
        if overlap(before) or not overlap(now):
            continue
        landings.append((before, now))
        if len(landings) == count:
            break
    return landings


def has_one_normal(contacts):
    return bool((contacts.nhat_BA_W @ contacts.nhat_BA_W[0] > 1 - 1e-9).all())


@pytest.mark.parametrize("name", [*SHIPPED, *REAL])
def test_first_after_a_step_and_global_agree(name):
    path = MODELS / f"{name}.obj" if name in SHIPPED else REAL_MESHES / name
    if not path.exists():
        pytest.skip(f"the real mesh {name} is not beside the repository")
    mesh = load_mesh(path)
    if np.ptp(mesh.vertices, axis=0).max() > 1.0:  # in mm
        mesh = Mesh.from_arrays(1e-3 * mesh.vertices, mesh.triangles)
    tool_mesh = box_mesh([4e-3, 4e-3, 4e-3])
    tool, solid = decompose(tool_mesh, cache=False), decompose(mesh)
    landings = draw_landings(mesh, Overlap(tool_mesh, Surface(mesh)), 20)
    assert landings
    trackers = {
        key: SceneTracker(tool, [solid], key[1], depth=key[0])
        for key in product(("tracked", "global"), (0.0, 1e-4))
    }
    compared = 0
    for k, (before, now) in enumerate(landings):
        tolerance_m = (0.0, 1e-4)[k % 2]
        found = {}
        for depth in ("tracked", "global"):
            tracker = trackers[depth, tolerance_m]
            tracker.reset()
            found[depth] = tracker.query(now)
            tracker.reset()
            assert min(tracker.query(before).distance, default=1.0) >= 0
            found[f"{depth}, after a step"] = tracker.query(now)
        step_m = np.linalg.norm(now[4:] - before[4:])
        for case, contacts in found.items():
            assert min(contacts.distance, default=1.0) < 0, (k, case)
            # The step leads out again: no way out needs to be longer.
            assert -max(contacts.distance[contacts.distance < 0]) < step_m, (k, case)
        if all(map(has_one_normal, found.values())):
            compared += 1
            deepest = [c.distance.min() for c in found.values()]
            np.testing.assert_allclose(deepest, deepest[0], atol=1e-7, err_msg=str(k))
    assert compared > 0


def test_a_box_that_skips_the_skin_lands_on_the_floor(tmp_path):
    """A plant's step carries it past the tolerance: it lands, and gains no energy."""
    mass, half_m, stiffness, start_m, speed = 0.1, 0.01, 5e3, 2e-3, 0.3
    contact = ContactParameters(
        tolerance_m=1e-5, stiffness_N_per_m=stiffness, damping_Ns_per_m=10.0
    )
    path = tmp_path / "tray.obj"
    V, F = tray(floor=FLOOR_M)
    lines = [f"v {x} {y} {z}" for x, y, z in V]
    path.write_text("\n".join([*lines, *(f"f {a} {b} {c}" for a, b, c in F + 1)]))
    scene = PlantScene()
    scene.add("tool", Box(2 * half_m, 2 * half_m, 2 * half_m), mass=mass, side=0.02)
    scene.add_fixed("tray", MeshShape(str(path)))
    rendering = scene.finalize().render(contact=contact)
    assert rendering.skin_speed_m_per_s < speed
    tilt = RotationMatrix.MakeXRotation(1e-4)
    scene.start(tool=RigidTransform(tilt, [0, 0, FLOOR_M + half_m + start_m]))
    tool = scene.plant.GetBodyByName("tool")
    scene.plant.SetFreeBodySpatialVelocity(
        scene.context, tool, SpatialVelocity([0, 0, 0], [0, 0, -speed])
    )
    given_J = mass * (speed**2 / 2 + G * start_m)
    for end_s in np.arange(0.01, 2.0, 0.01):
        scene.simulator.AdvanceTo(end_s)
        height_m = scene.pose("tool").translation()[2] - FLOOR_M - half_m
        moving_J = mass * scene.velocity("tool")[3:] @ scene.velocity("tool")[3:] / 2
        assert height_m > -2e-3
        assert moving_J + mass * G * height_m < 1.02 * given_J
    # It rests; how it rocks there is a matter of the explicit step.
    assert moving_J < 1e-3 * given_J
    assert -2 * mass * G / stiffness < height_m < 2e-5


@pytest.mark.parametrize("depth", ["tracked", "global"])
@pytest.mark.parametrize("offset_m", [0.0, 1e-18, -7e-18, 1e-12, -1e-12, 1e-6])
def test_a_first_query_of_faces_that_touch_leads_through_no_far_side(offset_m, depth):
    """A box lies flush on a slab of 0.1 m."""
    tool, slab = box((0.04, 0.04, 0.04)), box((1.0, 1.0, 0.1))
    tracker = ContactTracker(tool, slab, 2e-3, depth=depth)
    (contact,) = tracker.query(pose([0, 0, 0.07 + offset_m]), IDENTITY)
    assert contact.distance == pytest.approx(offset_m, abs=1e-11)
    np.testing.assert_allclose(contact.nhat_BA_W, [0, 0, 1], atol=1e-12)
