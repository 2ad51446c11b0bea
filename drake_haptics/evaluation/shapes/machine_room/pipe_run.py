"""Pipe runs: straight spools, bends, flanged joints, valves and clamps."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from drake_haptics.evaluation.shapes.machine_room.equipment import make_clamp
from drake_haptics.evaluation.shapes.machine_room.fittings import (
    BEND,
    flange_length,
    flange_radius,
    flange_thickness,
    make_bonnet,
    make_elbow,
    make_flange,
    make_handwheel,
    make_nut,
    make_pipe,
    make_valve_body,
    valve_length,
)
from drake_haptics.evaluation.shapes.machine_room.room import RoomBuilder, pose

_LONGEST_SPOOL_M = 1.7
_CLAMPED_FROM_M = 0.7


def add_pipe_run(
    room: RoomBuilder,
    corners: Sequence[Sequence[float]],
    radius: float,
    *,
    stem: Sequence[float],
    valves: Collection[int] = (),
) -> None:
    """Adds pipes along the axis through `corners`, with bends between them.

    Straight parts are cut into flanged spools, each held by a clamp.

    Args:
        room: to add to.
        corners: (k, 3) of the axis, m; consecutive lines at right angles.
        radius: of the pipe, m.
        stem: (3,) unit, direction of the valves' stems, normal to the valves' pipes.
        valves: indices of the straight parts that have a valve in their middle.
    """
    points = np.asarray(corners, dtype=float)
    directions = np.diff(points, axis=0)
    lengths = np.linalg.norm(directions, axis=1)
    directions /= lengths[:, None]
    reach = BEND * radius
    for k, (start, u) in enumerate(zip(points[:-1], directions, strict=True)):
        is_first, is_last = k == 0, k == len(directions) - 1
        start = start if is_first else start + reach * u
        length = lengths[k] - reach * ((not is_first) + (not is_last))
        if k in valves:
            rest = (length - valve_length(radius)) / 2
            _add_straight(room, start, u, rest, radius, ends_flanged=(False, True))
            _add_valve(room, start + rest * u, u, np.asarray(stem), radius)
            start = start + (rest + valve_length(radius)) * u
            _add_straight(room, start, u, rest, radius, ends_flanged=(True, False))
        else:
            _add_straight(room, start, u, length, radius, ends_flanged=(False, False))
        if not is_last:
            bend = pose(points[k + 1] - reach * u, u, directions[k + 1])
            room.place(make_elbow, [radius], bend)


def _add_straight(
    room: RoomBuilder,
    start: np.ndarray,
    u: np.ndarray,
    length: float,
    radius: float,
    ends_flanged: tuple[bool, bool],
) -> None:
    """Spools of equal length one after the other, with flanges where they meet."""
    count = int(np.ceil(length / _LONGEST_SPOOL_M))
    spool = length / count
    x = _normal_to(u)
    for k in range(count):
        near = k > 0 or ends_flanged[0]
        far = k < count - 1 or ends_flanged[1]
        low = start + k * spool * u
        high = low + spool * u
        inset = flange_length(radius)
        bare = spool - inset * (near + far)
        pipe = low + inset * near * u
        room.place(make_pipe, [radius, bare], pose(pipe, u, x))
        if bare > _CLAMPED_FROM_M:
            room.place(make_clamp, [radius], pose(pipe + bare / 2 * u, u, x))
        if near:
            _add_flange(room, low + inset * u, -u, x, radius)
        if far:
            _add_flange(room, high - inset * u, u, x, radius)


def _add_flange(
    room: RoomBuilder, neck: np.ndarray, u: np.ndarray, x: np.ndarray, radius: float
) -> None:
    """A flange from `neck` along u, and the nuts on its back."""
    room.place(make_flange, [radius], pose(neck, u, x))
    back = neck + (flange_length(radius) - flange_thickness(radius)) * u
    room_for_nut = flange_radius(radius) - 1.3 * radius
    circle = 1.3 * radius + room_for_nut / 2
    count = 4 if radius < 0.06 else 8
    y = np.cross(u, x)
    for k in range(count):
        angle = 2 * np.pi * (k + 0.5) / count
        outward = np.cos(angle) * x + np.sin(angle) * y
        nut = pose(back + circle * outward, -u, outward)
        room.place(make_nut, [0.45 * room_for_nut], nut)


def _add_valve(
    room: RoomBuilder, start: np.ndarray, u: np.ndarray, stem: np.ndarray, radius: float
) -> None:
    """A valve's body from `start` along u, with bonnet and wheel along `stem`."""
    middle = start + valve_length(radius) / 2 * u
    room.place(make_valve_body, [radius], pose(start, u, stem))
    room.place(make_bonnet, [radius], pose(middle, stem, u))
    wheel = 2.4 * radius + 0.03
    room.place(make_handwheel, [wheel], pose(middle + 8.0 * radius * stem, stem, u))


def _normal_to(u: np.ndarray) -> np.ndarray:
    """A unit vector normal to u, which is along an axis."""
    return np.roll(np.abs(u), 1)
