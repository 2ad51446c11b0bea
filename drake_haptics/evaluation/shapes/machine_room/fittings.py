"""Pipes and what is bolted to them. All run along +z from the origin."""

from __future__ import annotations

from itertools import pairwise

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

_SECTORS = 26
# A bend's radius over the pipe's.
BEND = 3.0
# A handwheel: vertices around its rim and around the rim's section, and spokes.
_RIM, _RIM_SECTION, _SPOKES = 32, 8, 4


def flange_length(radius: float) -> float:
    """Length along the pipe of a flange for a pipe of `radius`, both m."""
    return 0.6 * radius + 0.012


def flange_radius(radius: float) -> float:
    """Radius of a flange for a pipe of `radius`, both m."""
    return 1.7 * radius + 0.015


def flange_thickness(radius: float) -> float:
    """Thickness of a flange's rim for a pipe of `radius`, both m."""
    return 0.3 * radius + 0.006


def valve_length(radius: float) -> float:
    """Length along the pipe of a valve for a pipe of `radius`, both m."""
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
        size: diameter of the stud, m; the nut is 0.8 of it high.
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
    """The (radius, z) of a flange's neck and rim."""
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
    """A short cylinder with an opening for each spoke; returns their rims."""
    count = 2 * _SPOKES
    levels = [(0.9, -1.0), (1.0, -0.5), (1.0, 0.5), (0.9, 1.0)]
    angle = 2 * np.pi * (np.arange(count) - 0.5) / count
    x, y = np.cos(angle), np.sin(angle)
    rings = [
        builder.add_ring(radius * np.column_stack([r * x, r * y, np.full(count, z)]))
        for r, z in levels
    ]
    builder.add_fan(rings[0], builder.add_vertex((0, 0, -radius)), at_start=True)
    for row, (near, far) in enumerate(pairwise(rings)):
        builder.add_band(near, far, holes=range(0, count, 2) if row == 1 else ())
    builder.add_fan(rings[-1], builder.add_vertex((0, 0, radius)), at_start=False)
    return [opening_loop(rings[1:3], [k, k + 1]) for k in range(0, count, 2)]


def _add_rim(
    builder: SurfaceBuilder, radius: float, thickness: float
) -> list[list[int]]:
    """A torus with an opening for each spoke on its inside; returns their rims."""
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
