"""Shapes in contact whose wrench has a closed form, answered by the whole chain.

All vectors are in the scenario's frame S, lengths in m; t is the tolerance, d the
distance of a contact, n its normal, k the stiffness.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
from cell_mesh import cell_mesh
from contact_samples import box, hull
from hard_cases.bodies import ball, roof
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from slide_rig import cut
from slide_scenes import triangles_of_top
from wrench_chain import (
    ROUND_OFF,
    STIFFNESS_N_PER_M,
    TOLERANCE_M,
    Body,
    Case,
    place,
    run_chain,
    wrench_at,
)

from drake_haptics._core import ConvexPieces
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh

K, T = STIFFNESS_N_PER_M, TOLERANCE_M
X, Y, Z = np.eye(3)
# Of tools in their own frame, so that no torque is taken about a point of symmetry.
OFFSET = np.array([3e-3, -2e-3, 7e-3])
DISTANCES_M = (4e-4, -3e-4)
RADIUS_M = 0.01


def make_floor() -> Body:
    """A plate whose top is z = 0, 200 mm wide."""
    return place(box([0.2, 0.2, 0.02], [0, 0, -0.01]))


def make_sphere() -> np.ndarray:
    """Vertices (n, 3) of a tessellated sphere; the first is its lowest."""
    points = ball(3, RADIUS_M)
    down, _ = Rotation.align_vectors([-Z], [points[0]])
    return down.apply(points)


def sphere_on_plane(method: str) -> Iterator[Case]:
    """A sphere against the plane: the lowest vertex exactly, and the smooth sphere."""
    shape = hull(make_sphere() - OFFSET)
    expected, measured = [], []
    for d in DISTANCES_M:
        tool = place(shape, np.array([0.02, 0.01, d + RADIUS_M]) + OFFSET)
        expected.append(wrench_at(-OFFSET - RADIUS_M * Z, K * (T - d) * Z))
        measured.append(run_chain(tool, [make_floor()], method).tool)
    yield Case(
        "sphere on plane, a vertex lowest",
        "f = k (t − d) n at the vertex",
        "1, 5, 6, 9",
        method,
        np.array(expected),
        np.array(measured),
        RADIUS_M,
    )
    points = make_sphere()
    equations = ConvexHull(points).equations
    cos_facet = -equations[:, 3].max() / RADIUS_M
    d, measured = -3e-4, []
    turns = Rotation.random(40, random_state=0)
    for turn in turns:
        tool = place(hull(points), [0, 0, d + RADIUS_M], turn.as_rotvec())
        measured.append(run_chain(tool, [make_floor()], method).tool)
    yield Case(
        "tessellated sphere at 40 orientations",
        "that of the smooth sphere; bound: sin of a facet's radius",
        "5, 6, 9",
        method,
        np.tile(wrench_at(-RADIUS_M * Z, K * (T - d) * Z), (len(turns), 1)),
        np.array(measured),
        RADIUS_M,
        max(np.sqrt(1 - cos_facet**2), RADIUS_M * (1 - cos_facet) / (T - d)),
    )


def _flush_on_floor(
    name: str,
    method: str,
    shape: ConvexPieces,
    p_xy: list[float],
    middle: list[float],
    size_m: float,
) -> Case:
    """A shape on the floor, seen from above at `p_xy`, that touches about `middle`."""
    expected, measured = [], []
    for d in DISTANCES_M:
        tool = place(shape, np.array([*p_xy, d]) + OFFSET)
        expected.append(wrench_at(np.array(middle) - OFFSET, K * (T - d) * Z))
        measured.append(run_chain(tool, [make_floor()], method).tool)
    return Case(
        name,
        "f = k (t − d) n at the middle of the overlap",
        "6, 9",
        method,
        np.array(expected),
        np.array(measured),
        size_m,
    )


def edge_on_plane(method: str) -> Iterator[Case]:
    """A ridge, whole and half beyond the plane's rim."""
    length = 8e-3
    shape = hull(roof(length, 4e-3, 6e-3) - OFFSET)
    for name, x, middle in (
        ("edge on plane", 0.0, 0.0),
        ("edge on plane, half beyond the rim", 0.1, -length / 2),
    ):
        yield _flush_on_floor(name, method, shape, [x, 0], [middle, 0, 0], length)


def face_on_plane(method: str) -> Iterator[Case]:
    """A face, whole and a quarter of it on the plane's corner."""
    half = np.array([8e-3, 6e-3, 3e-3])
    shape = box(2 * half, half[2] * Z - OFFSET)
    for name, p_xy, middle in (
        ("face on plane", [0, 0], [0, 0, 0]),
        ("face on plane's corner", [0.1, 0.1], [-half[0] / 2, -half[1] / 2, 0]),
    ):
        yield _flush_on_floor(name, method, shape, p_xy, middle, half[0])


def make_walls(count: int) -> list[Body]:
    """Slabs behind x = 0, y = 0 and z = 0."""
    slab = [box(0.04 + 0.04 * (1 - n), 0.02 * (1 - 2 * n)) for n in (X, Y, Z)]
    return [place(shape) for shape in slab[:count]]


def _inner_corner() -> Body:
    """A solid with three walls that meet at the origin, in the positive octant."""
    size = 0.04
    mesh = cell_mesh(set(product((0, 1), repeat=3)) - {(1, 1, 1)}, size)
    moved = Mesh.from_arrays(mesh.vertices - size, mesh.triangles)
    return place(decompose(moved, cache=False).core)


def peg_against_walls(method: str) -> Iterator[Case]:
    """A peg in a corner of two walls, of three, and between two that are opposed."""
    half = np.array([5e-3, 5e-3, 1.2e-2])
    peg = box(2 * half, -OFFSET)
    near, deep = np.array([2e-4, 5e-4, 3e-4]), np.array([-3e-4, 4e-4, -1e-4])
    for name, walls, d, count in (
        ("peg against two walls", make_walls(2), deep, 2),
        ("peg in a corner of three walls", make_walls(3), deep, 3),
        ("peg in a corner of three walls, one solid", [_inner_corner()], near, 3),
    ):
        # Beside two walls the peg stands well above z = 0.
        lift = np.array([0, 0, 0.01 * (count == 2)])
        tool = place(peg, half + d + lift + OFFSET)
        expected = sum(
            wrench_at(-half[i] * n - OFFSET, K * (T - d[i]) * n)
            for i, n in enumerate((X, Y, Z)[:count])
        )
        yield Case(
            name,
            "Σ k (t − dᵢ) nᵢ at the middles of the peg's sides",
            "6, 9",
            method,
            expected,
            run_chain(tool, walls, method).tool,
            half[2],
        )
    left = place(box([0.02, 0.04, 0.04], -0.01 * X))
    right = place(box([0.02, 0.04, 0.04], 0.01 * X + (2 * half[0] + 5e-4) * X))
    d = 1e-4
    tool = place(peg, (half[0] + d) * X + OFFSET)
    yield Case(
        "peg between two walls",
        "k (d₂ − d₁) n₁",
        "6, 9",
        method,
        wrench_at(-OFFSET, K * (5e-4 - 2 * d) * X),
        run_chain(tool, [left, right], method).tool,
        half[2],
    )


def _cut_plate(pieces: int) -> Body:
    """A plate of 100 × 50 mm, top z = 0, the top in 1, 4 or 50 equal pieces."""
    columns, rows = {1: (1, 1), 4: (2, 2), 50: (10, 5)}[pieces]
    mesh = cell_mesh(product(range(10), range(5), (0,)), 0.01)
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    a, b, c = np.swapaxes(mesh.vertices[mesh.triangles], 0, 1)
    sides = np.round(np.cross(b - a, c - a) @ [1e4, 2e4, 3e4])
    cell = (middles[:, :2] // [0.1 / columns, 0.05 / rows]) @ [10, 1]
    labels = np.where(triangles_of_top(mesh), 1000 + cell, sides)
    return place(cut(mesh, labels), -0.01 * Z)


def cut_face(method: str, pieces: int) -> Iterator[Case]:
    """A box on a face that is cut: level, on an edge and on a corner."""
    half = np.array([0.016, 0.012, 3e-3])
    shape = box(2 * half, half[2] * Z - OFFSET)
    plate = _cut_plate(pieces)
    # The octree makes one spring of it only if δ is of the tool's size.
    delta = 0.04
    at = np.array([0.047, 0.026, 0.0])
    for name, tilt, middle in (
        ("level", [0, 0, 0], [0, 0, 0]),
        ("tilted onto an edge", [0, 0.2, 0], [half[0], 0, 0]),
        ("tilted onto a corner", [0.2, 0.2, 0], [half[0], -half[1], 0]),
    ):
        R = Rotation.from_rotvec(tilt)
        foot = R.apply(middle)
        expected, measured = [], []
        for d in DISTANCES_M:
            origin = at + (d - foot[2]) * Z + R.apply(OFFSET)
            expected.append(wrench_at(foot - R.apply(OFFSET), K * (T - d) * Z))
            tool = place(shape, origin, tilt)
            measured.append(run_chain(tool, [plate], method, delta).tool)
        yield Case(
            f"box on a face in {pieces}, {name}",
            "f = k (t − d) n at the middle of the overlap",
            "6, 9",
            method,
            np.array(expected),
            np.array(measured),
            half[0],
            # The octree weighs all pieces alike, however little of the box is on one.
            np.inf if method == "octree" and pieces > 1 else ROUND_OFF,
        )
