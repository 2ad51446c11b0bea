"""What stands in a machine room beside its pipes. All stand on z = 0."""

from __future__ import annotations

import numpy as np

from drake_haptics.evaluation.shapes.opening import opening_loop
from drake_haptics.evaluation.shapes.surface import (
    Surface,
    SurfaceBuilder,
    circle,
    loft,
    revolve,
)
from drake_haptics.evaluation.shapes.sweep import rounded_path, sweep_tube

_RAIL_SECTORS = 8


def make_slab(x: float, y: float, z: float, chamfer: float = 0.004) -> Surface:
    """Returns a block of the size x, y, z, centered on the z axis, all m."""
    levels = [(chamfer, 0.0), (0.0, chamfer), (0.0, z - chamfer), (chamfer, z)]
    outlines = (_outline(x, y, inset, chamfer, at) for inset, at in levels)
    return loft((0, 0, 0), outlines, (0, 0, z))


def make_cabinet(width: float, depth: float, height: float) -> Surface:
    """Returns a cabinet with a recessed door; width in x, door towards -y.

    Args:
        width: m.
        depth: m.
        height: m.
    """
    edge, frame, recess = 0.004, 0.03, 0.012
    levels = [
        (edge, 0.0), (0.0, edge), (0.0, depth - edge), (edge, depth),
        (frame, depth), (frame + 0.002, depth - recess),
    ]  # fmt: skip
    # Lofted along the depth, then stood up: z to -y, y to z.
    outlines = (_outline(width, height, inset, edge, at) for inset, at in levels)
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
        radius: of the ribs, m.
        length: without the shaft, m.
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
        length: between its ends' axes, m.
        reach: height of the rod's axis over its ends, m.
        radius: m.
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
    rings = [builder.add_ring(circle(radius + wall * w, z, 24)) for w, z in corners]
    for near, far in zip(rings, rings[1:] + rings[:1], strict=True):
        builder.add_band(near, far)
    return builder.build()


def make_ladder(height: float, width: float, rungs: int, radius: float) -> Surface:
    """Returns two rails along z, at x = 0 and `width`, with rungs between them.

    Args:
        height: of the rails, m.
        width: between the rails' axes, m.
        rungs: evenly spaced, the first and last half a space from the ends.
        radius: of the rails, m.
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
        # Seen from the left the right loop runs backwards, and begins two on.
        builder.add_band(near, [far[2 - k] for k in range(len(far))])
    return builder.build()


def _add_rail(
    builder: SurfaceBuilder, x: float, side: int, radius: float, levels: list[float]
) -> list[list[int]]:
    """A rail with openings towards `side` of x; returns their rims, of 8 vertices."""
    angle = 2 * np.pi * np.arange(_RAIL_SECTORS) / _RAIL_SECTORS
    if side < 0:
        angle = angle + np.pi
    rings = [
        builder.add_ring(
            np.column_stack(
                [
                    x + radius * np.cos(angle),
                    radius * np.sin(angle),
                    np.full(_RAIL_SECTORS, z),
                ]
            )
        )
        for z in levels
    ]
    builder.add_fan(rings[0], builder.add_vertex((x, 0, levels[0])), at_start=True)
    columns = [_RAIL_SECTORS - 1, 0, 1]
    loops = []
    for row in range(len(rings) - 1):
        is_open = row % 3 != 0
        builder.add_band(rings[row], rings[row + 1], columns[:-1] if is_open else ())
        if row % 3 == 1:
            loops.append(opening_loop(rings[row : row + 3], columns))
    builder.add_fan(rings[-1], builder.add_vertex((x, 0, levels[-1])), at_start=False)
    return loops


def _outline(x: float, y: float, inset: float, cut: float, z: float) -> np.ndarray:
    """A rectangle with cut corners about the z axis, `inset` within its sides."""
    a, b = x / 2 - inset, y / 2 - inset
    corners = [
        (a, -b + cut), (a, b - cut), (a - cut, b), (-a + cut, b),
        (-a, b - cut), (-a, -b + cut), (-a + cut, -b), (a - cut, -b),
    ]  # fmt: skip
    return np.array([(*corner, z) for corner in corners])
