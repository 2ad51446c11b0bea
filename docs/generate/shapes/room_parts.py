"""Makes the parts of a machine room: pipes, their fittings, and equipment.

Pipes and fittings run along +z from the origin; equipment stands on z = 0.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from shapes.solids import chamfered_outline
from shapes.surface import (
    Surface,
    SurfaceBuilder,
    circle,
    loft,
    opening_loop,
    revolve,
    rounded_path,
    sweep_tube,
)

_SECTORS = 26
# A bend's radius over the pipe's.
BEND = 3.0
# A handwheel: vertices around its rim and around the rim's section, and spokes.
_RIM, _RIM_SECTION, _SPOKES = 32, 8, 4
_RAIL_SECTORS = 8


def flange_length(radius: float) -> float:
    """Returns the length along the pipe of a flange for a pipe of `radius`, both m."""
    return 0.6 * radius + 0.012


def flange_radius(radius: float) -> float:
    """Returns the radius of a flange for a pipe of `radius`, both m."""
    return 1.7 * radius + 0.015


def flange_thickness(radius: float) -> float:
    """Returns the thickness of a flange's rim for a pipe of `radius`, both m."""
    return 0.3 * radius + 0.006


def valve_length(radius: float) -> float:
    """Returns the length along the pipe of a valve for a pipe of `radius`, both m."""
    return 6.0 * radius + 0.06


def make_pipe(radius: float, length: float) -> Surface:
    """Returns a straight pipe, closed at its ends. `radius` and `length` in m."""
    return revolve([(0, 0), (radius, 0), (radius, length), (0, length)], _SECTORS)


def make_elbow(radius: float) -> Surface:
    """Returns a quarter bend from +z to +x; its axis has the radius `BEND` * radius."""
    reach = BEND * radius
    corners = np.array([(0, 0, 0), (0, 0, reach), (reach, 0, reach)])
    # Straight lines of no length at either end.
    path = rounded_path(corners * [1, 1, 1], reach, bend_steps=12)
    return sweep_tube(path, np.array([0.0, 1.0, 0.0]), radius, _SECTORS)


def make_flange(radius: float) -> Surface:
    """Returns a welding-neck flange; its face is at z = `flange_length(radius)`."""
    return revolve([(0, 0), *_flange(radius), (0, flange_length(radius))], _SECTORS)


def make_nut(size: float) -> Surface:
    """Returns a hexagon nut on the end of a stud.

    Args:
        size: Diameter of the stud, m; the nut is 0.8 of it high.
    """
    angle = 2 * np.pi * np.arange(12) / 12
    apothem = 0.8 * size
    # Twelve points: the corners, and the middles of the sides.
    reach = np.where(np.arange(12) % 2 == 0, apothem / np.cos(np.pi / 6), apothem)
    hexagon = np.column_stack([np.cos(angle), np.sin(angle)]) * reach[:, None]
    sections = [
        np.column_stack([hexagon, np.full(12, z)]) for z in (0.0, 0.68 * size)
    ] + [
        circle(r * size, z * size, 12)
        for r, z in ((0.76, 0.76), (0.5, 0.80), (0.45, 1.12))
    ]
    return loft((0, 0, 0), sections, (0, 0, 1.12 * size))


def make_valve_body(radius: float) -> Surface:
    """Returns a valve's body with a flange at either end."""
    length, neck = valve_length(radius), 1.05 * radius
    face = flange_radius(radius)
    half = [
        (face, 0.0),
        (face, flange_thickness(radius)),
        (1.3 * neck, flange_thickness(radius)),
        (neck, flange_thickness(radius) + 0.010),
        (1.1 * neck, 0.25 * length),
        (1.6 * neck, 0.33 * length),
        (1.85 * neck, 0.42 * length),
    ]
    middle = (1.95 * neck, 0.5 * length)
    back = [(r, length - z) for r, z in reversed(half)]
    return revolve([(0, 0), *half, middle, *back, (0, length)], _SECTORS)


def make_bonnet(radius: float) -> Surface:
    """Returns a valve's bonnet and stem, up to z = 8.4 `radius`."""
    profile = [
        (0.0, 1.5), (1.0, 1.5), (1.1, 2.6), (1.6, 2.7), (1.6, 3.3), (1.1, 3.5),
        (0.8, 4.2), (0.55, 5.6), (0.5, 6.6), (0.22, 6.8), (0.22, 8.3), (0.16, 8.4),
        (0.0, 8.4),
    ]  # fmt: skip
    return revolve([(r * radius, z * radius) for r, z in profile], _SECTORS)


def make_handwheel(radius: float) -> Surface:
    """Returns a wheel of four spokes about z. `radius` is that of the rim, m."""
    builder = SurfaceBuilder()
    hub = _add_hub(builder, 0.16 * radius)
    rim = _add_rim(builder, radius, 0.09 * radius)
    for near, far in zip(hub, rim, strict=True):
        # A branch that arrives runs through the loop backwards, from the same corner.
        builder.add_band(near, [far[0], *far[:0:-1]])
    return builder.build()


def _flange(radius: float) -> list[tuple[float, float]]:
    """Returns the (radius, z) of a flange's neck and rim."""
    length, outer = flange_length(radius), flange_radius(radius)
    back = length - flange_thickness(radius)
    return [
        (radius, 0.0),
        (1.3 * radius, back),
        (outer, back),
        (outer, length - 0.002),
        (outer - 0.002, length),
    ]


def _add_hub(builder: SurfaceBuilder, radius: float) -> list[list[int]]:
    """Adds a short cylinder with an opening for each spoke; returns their rims."""
    count = 2 * _SPOKES
    levels = [(0.9, -1.0), (1.0, -0.5), (1.0, 0.5), (0.9, 1.0)]
    angle = 2 * np.pi * (np.arange(count) - 0.5) / count
    x, y = np.cos(angle), np.sin(angle)
    rings = builder.add_tube(
        (
            radius * np.column_stack([r * x, r * y, np.full(count, z)])
            for r, z in levels
        ),
        start=(0, 0, -radius),
        end=(0, 0, radius),
        holes=lambda row: range(0, count, 2) if row == 1 else (),
    )
    return [opening_loop(rings[1:3], [k, k + 1]) for k in range(0, count, 2)]


def _add_rim(
    builder: SurfaceBuilder, radius: float, thickness: float
) -> list[list[int]]:
    """Adds a torus with an opening for each spoke inside; returns their rims."""
    tube = 2 * np.pi * (np.arange(_RIM_SECTION) + 0.5) / _RIM_SECTION
    inner = _RIM_SECTION // 2 - 1
    reach, z = radius + thickness * np.cos(tube), -thickness * np.sin(tube)
    angle = 2 * np.pi * (np.arange(_RIM) - 0.5) / _RIM
    rings = [
        builder.add_ring(np.column_stack([reach * np.cos(a), reach * np.sin(a), z]))
        for a in angle
    ]
    loops = []
    for k, (near, far) in enumerate(pairwise([*rings, rings[0]])):
        is_open = k % (_RIM // _SPOKES) == 0
        builder.add_band(near, far, holes=[inner] if is_open else ())
        if is_open:
            loops.append(opening_loop([near, far], [inner, inner + 1]))
    return loops


def make_cabinet(width: float, depth: float, height: float) -> Surface:
    """Returns a cabinet with a recessed door; width in x, door towards -y.

    Args:
        width: Width, m.
        depth: Depth, m.
        height: Height, m.
    """
    edge, frame, recess = 0.004, 0.03, 0.012
    levels = [
        (edge, 0.0), (0.0, edge), (0.0, depth - edge), (edge, depth),
        (frame, depth), (frame + 0.002, depth - recess),
    ]  # fmt: skip
    # Lofted along the depth, then stood up: z to -y, y to z.
    outlines = (
        chamfered_outline(width, height, inset, edge, at) for inset, at in levels
    )
    lying = loft((0, 0, 0), outlines, (0, 0, depth - recess))
    turn = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    standing = lying.vertices @ turn.T + [0, depth / 2, height / 2]
    return Surface(standing, lying.triangles)


def make_tank(radius: float, height: float) -> Surface:
    """Returns an upright tank with dished ends. `radius` and `height` in m."""
    dish = 0.4 * radius
    turn = np.linspace(0, np.pi / 2, 7)[1:]
    bottom = [(radius * np.sin(a), dish * (1 - np.cos(a))) for a in turn]
    top = [(r, height - z) for r, z in reversed(bottom)]
    return revolve([(0, 0), *bottom, *top, (0, height)], 48)


def make_motor(radius: float, length: float) -> Surface:
    """Returns a motor along +z with cooling ribs around it and a shaft at its end.

    Args:
        radius: Radius of the ribs, m.
        length: Length without the shaft, m.
    """
    profile = [(0.0, 0.0), (0.85 * radius, 0.0), (0.95 * radius, 0.08 * length)]
    for k in range(5):
        at = (0.14 + 0.14 * k) * length
        gap = 0.02 * length
        profile += [
            (0.9 * radius, at), (radius, at + gap), (radius, at + 4 * gap),
            (0.9 * radius, at + 5 * gap),
        ]  # fmt: skip
    profile += [
        (0.9 * radius, 0.88 * length),
        (0.6 * radius, length),
        (0.2 * radius, length),
        (0.2 * radius, 1.2 * length),
        (0.0, 1.2 * length),
    ]
    return revolve(profile, 24)


def make_handle(length: float, reach: float, radius: float) -> Surface:
    """Returns a bent rod from z = 0 up to `reach`, `length` along x, back to z = 0.

    Args:
        length: Distance between its ends' axes, m.
        reach: Height of the rod's axis over its ends, m.
        radius: Radius, m.
    """
    corners = np.array([(0, 0, 0), (0, 0, reach), (length, 0, reach), (length, 0, 0)])
    path = rounded_path(corners, 2.5 * radius, bend_steps=5)
    return sweep_tube(path, np.array([0.0, 1.0, 0.0]), radius, 12)


def make_clamp(radius: float) -> Surface:
    """Returns a ring of square section about z that holds a pipe of `radius`, m."""
    builder = SurfaceBuilder()
    wall, half = 0.004 + 0.1 * radius, 0.012 + 0.1 * radius
    # Up the outside and down the inside; the last ring joins the first.
    corners = [(1, -half), (1, half), (0, half), (0, -half)]
    rings = builder.add_tube(circle(radius + wall * w, z, 24) for w, z in corners)
    builder.add_band(rings[-1], rings[0])
    return builder.build()


def make_ladder(height: float, width: float, rungs: int, radius: float) -> Surface:
    """Returns two rails along z, at x = 0 and `width`, with rungs between them.

    Args:
        height: Height of the rails, m.
        width: Distance between the rails' axes, m.
        rungs: Number of rungs, the first and last half a space from the ends.
        radius: Radius of the rails, m.
    """
    builder = SurfaceBuilder()
    space, half = height / rungs, 0.6 * radius
    levels = [0.0, height]
    for k in range(rungs):
        middle = (k + 0.5) * space
        levels += [middle - half, middle, middle + half]
    left = _add_rail(builder, 0.0, 1, radius, sorted(levels))
    right = _add_rail(builder, width, -1, radius, sorted(levels))
    for near, far in zip(left, right, strict=True):
        # Seen from the left the right loop runs backwards, and begins two later.
        builder.add_band(near, [far[2 - k] for k in range(len(far))])
    return builder.build()


def _add_rail(
    builder: SurfaceBuilder, x: float, side: int, radius: float, levels: list[float]
) -> list[list[int]]:
    """Adds a rail with openings towards `side` of x; returns their rims."""
    angle = 2 * np.pi * np.arange(_RAIL_SECTORS) / _RAIL_SECTORS
    if side < 0:
        angle = angle + np.pi
    across, along = x + radius * np.cos(angle), radius * np.sin(angle)
    columns = [_RAIL_SECTORS - 1, 0, 1]
    rings = builder.add_tube(
        (np.column_stack([across, along, np.full(len(angle), z)]) for z in levels),
        start=(x, 0, levels[0]),
        end=(x, 0, levels[-1]),
        holes=lambda row: columns[:-1] if row % 3 else (),
    )
    return [
        opening_loop(rings[row : row + 3], columns)
        for row in range(1, len(rings) - 1, 3)
    ]
