"""Test the tracker of decomposed meshes where its pieces are hardest to join."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from cell_mesh import cell_mesh
from exact_minkowski import ExactPair
from hard_cases.bodies import ball, box
from hard_cases.passages import pose
from scipy.spatial import ConvexHull

from drake_haptics import ContactTracker, Decomposition, Mesh, decompose, load_mesh
from drake_haptics.models import FOLDER

MESHES = FOLDER / "meshes"
CLEARANCE = 2e-6  # m, of the peg to each wall of its hole


def solid(points: np.ndarray) -> Decomposition:
    """A convex body as a mesh (one piece)."""
    hull = ConvexHull(points)
    triangles = hull.simplices.copy()
    corners = points[triangles]
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", n, hull.equations[:, :3]) < 0
    triangles[inward] = triangles[inward, ::-1]
    return decompose(Mesh.from_arrays(points, triangles), cache=False)


def block_with_hole(half: float) -> Decomposition:
    """A block 60 × 60 × 40 mm with a square hole along z of that half width."""
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    rings = [
        np.column_stack([square * width, np.full(4, z)])
        for width, z in ((0.03, -0.02), (0.03, 0.02), (half, -0.02), (half, 0.02))
    ]
    low, high, low_in, high_in = (4 * k + np.arange(4) for k in range(4))
    triangles = []
    for p, q in ((low, high), (high, high_in), (high_in, low_in), (low_in, low)):
        for i in range(4):
            j = (i + 1) % 4
            triangles += [[p[i], p[j], q[j]], [p[i], q[j], q[i]]]
    return decompose(Mesh.from_arrays(np.concatenate(rings), triangles), cache=False)


def test_a_tight_peg_feels_each_wall_at_its_distance() -> None:
    errors, missing = peg_in_hole()
    assert missing == 0, f"{missing} times a wall is not felt"
    assert max(errors) < 1e-9 * 0.1


def peg_in_hole() -> tuple[list[float], int]:
    """A peg goes into a tight hole, rocking by micrometers.

    Returns:
        The errors (m) of the distances to walls that are felt, and how often one of the
        four is not, though all are far within the tolerance.
    """
    half = 0.01
    peg, hole = box(half, half, 0.03), half + CLEARANCE
    # The wall on the side −x, from the hole out, and the others by quarter turns.
    corners = [[-hole, -hole], [-hole, hole], [-0.03, 0.03], [-0.03, -0.03]]
    wall = np.array([[x, y, z] for x, y in corners for z in (-0.02, 0.02)])
    tracker = ContactTracker(solid(peg), block_with_hole(hole), 1e-4)
    rng = np.random.default_rng(0)
    missing, errors = 0, []
    for z in np.linspace(0.045, 0.012, 100):
        shift = rng.uniform(-1.2, 1.2, 2) * CLEARANCE
        X_WA = pose([*shift, z], rng.uniform(-1, 1, 3) * CLEARANCE / 0.1)
        found = tracker.query(X_WA, np.eye(4))
        for quarter in range(4):
            X_WB = pose(rotvec=[0, 0, quarter * np.pi / 2])
            truth = ExactPair(peg, wall, X_WA, X_WB).signed_distance
            mine = found.nhat_BA_W @ X_WB[:3, 0] > 0.9
            if mine.any():
                errors.append(abs(found.distance[mine].min() - truth))
            else:
                missing += 1
    return errors, missing


@pytest.mark.parametrize(
    "tool",
    [box(0.004, 0.005, 0.006), box(0.0005, 0.007, 0.003), ball(1, 0.005)],
    ids=["box", "plate", "ball"],
)
def test_a_tool_pressed_into_one_wall_of_a_corner_feels_the_others(
    tool: np.ndarray,
) -> None:
    """Turned at random, and brought from the middle of a pit into a corner of it.

    Where the tool's lowest vertex is in a wall, it is beyond the floor's border.
    """
    cell, tolerance = 0.02, 1e-3
    cells = set(itertools.product(range(3), range(3), range(2))) - {(1, 1, 1)}
    pit, body = decompose(cell_mesh(cells, cell), cache=False), solid(tool)
    # Its wall towards −x, and the others by turns of the axes.
    wall = cell * np.array([[1, 1, 1], [1, 2, 1], [1, 2, 2], [1, 1, 2]])
    rng = np.random.default_rng(0)
    for _ in range(60):
        X_WA = pose(rotvec=rng.normal(size=3))
        lowest = (tool @ X_WA[:3, :3].T).min(axis=0)
        pressed = -rng.uniform(0, 5e-4, 1)
        gaps = rng.permutation([*pressed, *rng.uniform(-5e-4, 9e-4, 2)])
        tracker = ContactTracker(body, pit, tolerance)
        for back in np.linspace(3e-3, 0, 16):
            X_WA[:3, 3] = cell - lowest + gaps + back
            found = tracker.query(X_WA, np.eye(4))
            for axis, gap in enumerate(gaps + back):
                if gap >= tolerance:
                    continue  # and so is all of the wall
                X_WB = np.eye(4)
                X_WB[:3, :3] = np.roll(np.eye(3), axis, axis=0)
                truth = gap
                if gap > 0:
                    truth = ExactPair(tool, wall, X_WA, X_WB).separation
                mine = found.nhat_BA_W[:, axis] > 0.71
                if truth < tolerance:
                    assert found.distance[mine].min() == pytest.approx(truth, abs=1e-9)


def nearest_of_surface(
    tool: np.ndarray, mesh: Mesh, X_WA: np.ndarray, reach: float
) -> float:
    """Exact distance of a convex tool to the triangles of a mesh within reach, m."""
    corners = mesh.vertices[mesh.triangles]
    middles = corners.mean(axis=1)
    radii = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
    radius = np.linalg.norm(tool, axis=1).max()
    apart = np.linalg.norm(middles - X_WA[:3, 3], axis=1) - radii - radius
    near = np.flatnonzero(apart < reach)
    return min(ExactPair(tool, corners[i], X_WA, np.eye(4)).separation for i in near)


def test_sliding_over_the_seams_of_a_torus_keeps_the_exact_distance() -> None:
    mesh = load_mesh(MESHES / "torus.obj", scale=1.0)
    extent = np.ptp(mesh.vertices, axis=0)
    major, tube = (extent.max() - extent.min()) / 2, extent.min() / 2
    tool = ball(0, 0.2 * tube)
    tolerance = 0.2 * tube
    tracker = ContactTracker(solid(tool), decompose(mesh), tolerance)
    axis = int(np.argmin(extent))
    for t in np.linspace(0, 2 * np.pi, 60, endpoint=False):
        out = np.roll([0, np.cos(t), np.sin(t)], axis)
        up = np.eye(3)[axis]
        around = np.cos(5 * t) * out + np.sin(5 * t) * up
        X_WA = pose(major * out + 1.25 * tube * around, [t, 2 * t, 0])
        found = tracker.query(X_WA, np.eye(4))
        truth = nearest_of_surface(tool, mesh, X_WA, 1.1 * tolerance)
        assert 0 < truth < tolerance
        # A piece's hull takes quads as flat that the file has rounded out of flat.
        assert found.distance.min() == pytest.approx(truth, abs=1e-7 * major)


PIN, BLOCK = (0.002, 0.002, 0.02), (0.03, 0.03, 0.01)


@pytest.mark.parametrize("thickness", [1e-3, 1e-5])
@pytest.mark.parametrize("case", ["pin through plate", "plate through block"])
def test_what_is_pushed_through_goes_on_pressing_on_the_top(
    case: str, thickness: float
) -> None:
    half = thickness / 2
    tool, below, heights = {
        "pin through plate": (PIN, (0.05, 0.05, half), (0.021, 0.006)),
        "plate through block": ((0.005, 0.005, half), BLOCK, (0.012, -0.008)),
    }[case]
    tracker = ContactTracker(solid(box(*tool)), solid(box(*below)), 1e-3)
    for z in np.linspace(*heights, 400):
        found = tracker.query(pose([0.003, 0.001, z]), np.eye(4))
        truth = z - tool[2] - below[2]
        if truth < 1e-3:
            assert found.distance.min() == pytest.approx(truth, abs=1e-12)
            np.testing.assert_allclose(found.nhat_BA_W, [[0, 0, 1]], atol=1e-9)
