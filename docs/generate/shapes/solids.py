"""Makes solids: block, cup, peg, pen, socket, sphere, spoon and torus."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from shapes.surface import Surface, SurfaceBuilder, circle, loft, revolve

_PEG_RADIUS_M = 0.012
_PEG_SIDES = 24
SOCKET_PLAY_M = 1e-4
"""Least play between the peg and the wall of the socket if they are coaxial, m."""
_CUP_SECTORS = 16
# Outer wall, (radius, height) in m from the table to the rim. Rows 1-3 and 5-7 bound
# the two openings where the handle leaves.
_OUTER = (
    (0.0265, 0.0000),
    (0.0300, 0.0030),
    (0.0325, 0.0140),
    (0.0335, 0.0210),
    (0.0345, 0.0280),
    (0.0366, 0.0440),
    (0.0375, 0.0510),
    (0.0384, 0.0580),
    (0.0400, 0.0700),
)
_LOWER_OPENING = (2, 4)
_UPPER_OPENING = (5, 7)
_RIM = (0.0385, 0.0718)
_INNER = ((0.0370, 0.0700), (0.0292, 0.0120), (0.0220, 0.0060))
_FLOOR_M = 0.005
_HANDLE_SECTIONS = 8
# Stations along the spoon, in m:
# x, half width, depth of the hollow, height of the edge, thickness.
_STATIONS = (
    (0.0010, 0.0045, 0.0004, 0.0002, 0.0016),
    (0.0050, 0.0092, 0.0030, 0.0003, 0.0018),
    (0.0110, 0.0122, 0.0056, 0.0005, 0.0019),
    (0.0180, 0.0132, 0.0070, 0.0007, 0.0020),
    (0.0250, 0.0122, 0.0064, 0.0010, 0.0020),
    (0.0310, 0.0094, 0.0042, 0.0016, 0.0021),
    (0.0360, 0.0058, 0.0018, 0.0026, 0.0023),
    (0.0410, 0.0034, 0.0004, 0.0045, 0.0026),
    (0.0480, 0.0027, 0.0000, 0.0082, 0.0027),
    (0.0620, 0.0027, 0.0000, 0.0145, 0.0026),
    (0.0850, 0.0031, 0.0000, 0.0215, 0.0025),
    (0.1080, 0.0038, 0.0000, 0.0258, 0.0024),
    (0.1220, 0.0043, 0.0000, 0.0270, 0.0023),
    (0.1290, 0.0030, 0.0000, 0.0272, 0.0021),
)
# Across the spoon, as a fraction of the half width. The edge is blunt: a top and a
# bottom vertex at each side.
_ACROSS = np.array([-1.0, -0.62, -0.21, 0.21, 0.62, 1.0])
_RING_RADIUS_M = 0.034
_TUBE_RADIUS_M = 0.012
_AROUND_RING = 50
_AROUND_TUBE = 20


def make_block() -> Surface:
    """Returns a block with chamfered edges that stands at the origin.

    100 mm x 70 mm x 30 mm, top face at z = 30 mm.
    """
    return make_slab(0.100, 0.070, 0.030, 0.002)


def make_slab(x: float, y: float, z: float, chamfer: float = 0.004) -> Surface:
    """Returns a block of the size x, y, z, centered on the z axis, all m."""
    levels = [(chamfer, 0.0), (0.0, chamfer), (0.0, z - chamfer), (chamfer, z)]
    outlines = (chamfered_outline(x, y, inset, chamfer, at) for inset, at in levels)
    return loft((0, 0, 0), outlines, (0, 0, z))


def chamfered_outline(
    x: float, y: float, inset: float, cut: float, z: float
) -> np.ndarray:
    """Returns a rectangle with cut corners about the z axis.

    Args:
        x: Length of the rectangle, m.
        y: Width of the rectangle, m.
        inset: Distance of the outline within the rectangle's sides, m.
        cut: Length of a cut along a side, m.
        z: Height of the outline, m.

    Returns:
        (8, 3) corners, m, counterclockwise about +z.
    """
    a, b = x / 2 - inset, y / 2 - inset
    corners = [
        (a, -b + cut), (a, b - cut), (a - cut, b), (-a + cut, b),
        (-a, b - cut), (-a, -b + cut), (-a + cut, -b), (a - cut, -b),
    ]  # fmt: skip
    return np.array([(*corner, z) for corner in corners])


def make_cup() -> Surface:
    """Returns a cup that stands at the origin, axis +z, handle towards +x.

    80 mm wide at the rim, 72 mm high, wall 3 mm, 504 triangles (the paper's Table 1
    has a cup of 500). The handle is swept between two openings in the outer wall, so
    the cup is one closed manifold.
    """
    builder = SurfaceBuilder()
    # The profile runs up the outside, over the rim and down the inside.
    profile = [*_OUTER, _RIM, *_INNER]
    open_rows = {*range(*_LOWER_OPENING), *range(*_UPPER_OPENING)}
    rings = builder.add_tube(
        (_sector_circle(r, z) for r, z in profile),
        start=(0, 0, 0),
        end=(0, 0, _FLOOR_M),
        holes=lambda row: {0} if row in open_rows else (),
    )
    _add_handle(builder, rings)
    return builder.build()


def _sector_circle(radius: float, z: float) -> np.ndarray:
    """Returns a ring whose column 0 is the sector that faces +x."""
    half_sector = np.pi / _CUP_SECTORS
    c, s = np.cos(half_sector), np.sin(half_sector)
    return circle(radius, z, _CUP_SECTORS) @ np.array(
        [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    )


def _add_handle(builder: SurfaceBuilder, rings: list[Sequence[int]]) -> None:
    """Sweeps a hexagonal section from the upper opening to the lower one."""
    low, middle, high = (rings[_UPPER_OPENING[0] + k] for k in range(3))
    near = [low[0], low[1], middle[1], high[1], high[0], middle[0]]
    # Along the way the section turns half round about y, so that its top ends below.
    low, middle, high = (rings[_LOWER_OPENING[0] + k] for k in range(3))
    last = [high[0], high[1], middle[1], low[1], low[0], middle[0]]
    shares = np.arange(1, _HANDLE_SECTIONS) / _HANDLE_SECTIONS
    *_, near = builder.add_tube(map(_handle_section, shares), rim=near)
    builder.add_band(near, last)


def _handle_section(s: float) -> np.ndarray:
    """Returns the section at the fraction `s` of the way from the upper opening."""
    turn = np.pi * s
    radial = np.array([np.sin(turn), 0, np.cos(turn)])
    center = np.array([0.036, 0, 0.036]) + radial * [0.030, 0, 0.0185]
    lateral = np.array([0.0, 1.0, 0.0])
    corners = ((-1, -3.0), (1, -3.0), (1.35, 0), (1, 3.0), (-1, 3.0), (-1.35, 0))
    return np.array(
        [center + 0.0042 * w * lateral + 1e-3 * h * radial for w, h in corners]
    )


def make_peg() -> Surface:
    """Returns a peg with chamfered ends along z, its lower end at the origin.

    24 mm in diameter, 120 mm long, 24-sided.
    """
    profile = [
        (0.0, 0.0),
        (0.009, 0.0),
        (_PEG_RADIUS_M, 0.004),
        (_PEG_RADIUS_M, 0.117),
        (0.010, 0.120),
        (0.0, 0.120),
    ]
    return revolve(profile, _PEG_SIDES)


def make_socket() -> Surface:
    """Returns a round block that stands at the origin, with a blind hole for the peg.

    64 mm in diameter, 35 mm high, 24-sided. The hole is 30 mm deep, with a chamfer of
    1.5 mm at its mouth. Its flats are `SOCKET_PLAY_M` outside of the circle through the
    edges of the peg, so that there is as much play however the peg is turned.
    """
    wall = (_PEG_RADIUS_M + SOCKET_PLAY_M) / np.cos(np.pi / _PEG_SIDES)
    profile = [
        (0.0, 0.0),
        (0.032, 0.0),
        (0.032, 0.035),
        (wall + 0.0015, 0.035),
        (wall, 0.0335),
        (wall, 0.005),
        (0.0, 0.005),
    ]
    return revolve(profile, _PEG_SIDES)


def make_pen() -> Surface:
    """Returns a pen along z, its tip at the origin.

    9 mm in diameter, 130 mm long, 12-sided; convex.
    """
    profile = [
        (0.0, 0.0),
        (0.0006, 0.0003),
        (0.0030, 0.012),
        (0.0045, 0.026),
        (0.0045, 0.127),
        (0.0035, 0.130),
        (0.0, 0.130),
    ]
    return revolve(profile, 12)


def make_sphere(divisions: int = 3) -> Surface:
    """Returns a sphere of radius 40 mm about the origin, as 1280 even triangles.

    It is an icosahedron whose triangles are divided three times. It has no poles, so
    that contact is of one kind along a path.

    Args:
        divisions: Number of divisions, each of which makes four triangles of one.
    """
    unit, triangles = divide_icosahedron(divisions)
    return Surface(np.round(0.040 * unit, 9), triangles)


def divide_icosahedron(divisions: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns even unit vectors and the triangles between them.

    Args:
        divisions: Number of times that each triangle of an icosahedron is divided into
            four.

    Returns:
        (n, 3) unit vectors and (m, 3) int32 indices, wound outward.
    """
    golden = (1 + np.sqrt(5)) / 2
    vertices = [
        np.array(p, dtype=float)
        for s in (-1, 1)
        for t in (-golden, golden)
        for p in ((0, s, t), (s, t, 0), (t, 0, s))
    ]
    # The icosahedron's faces are the triples of vertices at mutual distance 2.
    triangles = []
    for triple in combinations(range(12), 3):
        a, b, c = (vertices[i] for i in triple)
        if max(np.linalg.norm(a - b), np.linalg.norm(b - c), np.linalg.norm(c - a)) < 3:
            i, j, k = triple
            outwards = np.cross(b - a, c - a) @ a > 0
            triangles.append((i, j, k) if outwards else (i, k, j))
    for _ in range(divisions):
        triangles = _divide(vertices, triangles)
    unit = np.array([v / np.linalg.norm(v) for v in vertices])
    return unit, np.array(triangles, dtype=np.int32)


def _divide(
    vertices: list[np.ndarray], triangles: list[tuple[int, int, int]]
) -> list[tuple[int, int, int]]:
    """Divides each triangle into four; appends the middles of edges to `vertices`."""
    middles: dict[tuple[int, int], int] = {}

    def middle(i: int, j: int) -> int:
        key = (min(i, j), max(i, j))
        if key not in middles:
            p = vertices[i] / np.linalg.norm(vertices[i])
            q = vertices[j] / np.linalg.norm(vertices[j])
            vertices.append(p + q)
            middles[key] = len(vertices) - 1
        return middles[key]

    divided = []
    for i, j, k in triangles:
        ij, jk, ki = middle(i, j), middle(j, k), middle(k, i)
        divided += [(i, ij, ki), (j, jk, ij), (k, ki, jk), (ij, jk, ki)]
    return divided


def make_spoon() -> Surface:
    """Returns a spoon along +x, bowl opening to +z, tip at the origin.

    130 mm long, bowl 40 mm x 26 mm and 7 mm deep, metal 2 mm thick; 336 triangles, as
    the spoon of the paper's Table 1.
    """
    sections = (_make_crescent(*station) for station in _STATIONS)
    return loft((0, 0, -0.0006), sections, (0.1305, 0, 0.0262))


def _make_crescent(
    x: float, half_width: float, depth: float, edge: float, thickness: float
) -> np.ndarray:
    """Returns a crescent at x, counterclockwise about +x: underside, then top."""
    top = edge - depth * (1 - _ACROSS**2)
    # The metal thins to two thirds at the edge.
    bottom = top - thickness * (1 - _ACROSS**2 / 3)
    return np.column_stack(
        [
            np.full(2 * len(_ACROSS), x),
            half_width * np.concatenate([_ACROSS, _ACROSS[::-1]]),
            np.concatenate([bottom, top[::-1]]),
        ]
    )


def make_torus() -> Surface:
    """Returns a torus about z through the origin.

    92 mm wide with a hole of 44 mm; 2000 triangles, as the paper's Table 1.
    """
    builder = SurfaceBuilder()
    tube = 2 * np.pi * np.arange(_AROUND_TUBE) / _AROUND_TUBE
    reach = _RING_RADIUS_M + _TUBE_RADIUS_M * np.cos(tube)
    z = -_TUBE_RADIUS_M * np.sin(tube)
    # Counterclockwise about the direction of advance, which is +y at angle 0.
    rings = builder.add_tube(
        np.column_stack([reach * np.cos(angle), reach * np.sin(angle), z])
        for angle in 2 * np.pi * np.arange(_AROUND_RING) / _AROUND_RING
    )
    builder.add_band(rings[-1], rings[0])
    return builder.build()
