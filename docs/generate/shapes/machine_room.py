"""Lays out a machine room: pipe runs, an instrument panel, some 900 objects in all."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from drake_haptics.evaluation.models import FRONT_Y_M, PANEL_X_M
from shapes.room_parts import (
    BEND,
    flange_length,
    flange_radius,
    flange_thickness,
    make_bonnet,
    make_cabinet,
    make_clamp,
    make_elbow,
    make_flange,
    make_handle,
    make_handwheel,
    make_ladder,
    make_motor,
    make_nut,
    make_pipe,
    make_tank,
    make_valve_body,
    valve_length,
)
from shapes.solids import make_slab
from shapes.surface import Surface, rounded_path, sweep_tube

_LENGTH_M, _WIDTH_M, _HEIGHT_M = 10.0, 7.0, 3.2
# Radii of the pipes on the rack along the back wall, m.
_RACK_RADII_M = (0.084, 0.057, 0.057, 0.044, 0.030, 0.030, 0.024, 0.024)
# Radii of the risers along the left wall, m.
_RISER_RADII_M = (0.057, 0.044, 0.044, 0.030, 0.030, 0.024)
_LONGEST_SPOOL_M = 1.7
_CLAMPED_FROM_M = 0.7
NUM_TUBES = 15
_SPACING_M = 0.0235
_TUBE_RADII_M = (0.008, 0.006, 0.007)
_TUBE_Z_M = (0.9, 1.6)


@dataclass(frozen=True)
class PlacedShape:
    """An object of the room.

    Attributes:
        name: A unique name.
        shape: Key of its surface in `MachineRoom.shapes`.
        X_WO: (4, 4) pose of the surface's frame in the room.
    """

    name: str
    shape: str
    X_WO: np.ndarray


@dataclass(frozen=True)
class MachineRoom:
    """Shapes, and objects that are placed copies of them.

    Attributes:
        shapes: Surfaces by name, each in its own frame.
        objects: Objects in the order in which they were placed.
    """

    shapes: dict[str, Surface]
    objects: tuple[PlacedShape, ...]

    @property
    def num_triangles(self) -> int:
        """Triangles of all objects together."""
        return sum(len(self.shapes[o.shape].triangles) for o in self.objects)


class RoomBuilder:
    """Collects placed shapes; makes each shape once."""

    def __init__(self) -> None:
        self._shapes: dict[str, Surface] = {}
        self._objects: list[PlacedShape] = []
        self._num_of_kind: dict[str, int] = {}

    def place(
        self, make: Callable[..., Surface], sizes: Sequence[float], X_WO: np.ndarray
    ) -> None:
        """Places what `make(*sizes)` returns at the pose X_WO (4, 4).

        Args:
            make: A generator named make_<kind>.
            sizes: Arguments of the generator: lengths, m, rounded to 1 mm, so that
                shapes are shared; and counts, which are ints.
            X_WO: (4, 4) pose of the shape's frame in the room.
        """
        kind = make.__name__.removeprefix("make_")
        sizes = [s if isinstance(s, int) else round(s, 3) for s in sizes]
        labels = (str(s) if isinstance(s, int) else f"{1e3 * s:.0f}mm" for s in sizes)
        shape = "_".join([kind, *labels])
        if shape not in self._shapes:
            self._shapes[shape] = make(*sizes)
        count = self._num_of_kind[kind] = self._num_of_kind.get(kind, 0) + 1
        self._objects.append(PlacedShape(f"{kind}_{count:03d}", shape, X_WO))

    def build(self) -> MachineRoom:
        """Returns the room made so far."""
        return MachineRoom(dict(self._shapes), tuple(self._objects))


def pose(
    origin: Sequence[float] | np.ndarray,
    z: Sequence[float] | np.ndarray = (0, 0, 1),
    x: Sequence[float] | np.ndarray = (1, 0, 0),
) -> np.ndarray:
    """Returns X_WO (4, 4) from an origin, m, and the directions of two axes.

    Args:
        origin: (3,) origin, m.
        z: (3,) unit direction of the z axis.
        x: (3,) unit direction of the x axis, normal to z.
    """
    X = np.eye(4)
    X[:3, 2], X[:3, 0] = z, x
    X[:3, 1] = np.cross(X[:3, 2], X[:3, 0])
    X[:3, 3] = origin
    return X


def make_machine_room() -> MachineRoom:
    """Returns a machine room of about 900 objects and 196,000 triangles.

    10 m by 7 m with z up: pipe runs with bends, flanges, nuts, valves and clamps,
    pumps, tanks with ladders, cabinets, railings and a panel of instrument tubes. The
    complexity is that of the auxiliary machine room of Kim, Otaduy, Lin and Manocha
    2003, section 6.1: 897 objects of 195,926 triangles.
    """
    room = RoomBuilder()
    _add_walls(room)
    _add_rack_and_pumps(room)
    _add_rack_posts(room)
    _add_risers(room)
    _add_tanks(room)
    _add_cabinets(room)
    _add_railings(room)
    add_instrument_panel(room)
    return room.build()


def _add_walls(room: RoomBuilder) -> None:
    thick = 0.1
    middle = (_LENGTH_M / 2, _WIDTH_M / 2)
    room.place(make_slab, [_LENGTH_M, _WIDTH_M, thick], pose((*middle, -thick)))
    back = pose((_LENGTH_M / 2, _WIDTH_M + thick / 2, 0))
    room.place(make_slab, [_LENGTH_M, thick, _HEIGHT_M], back)
    left = pose((-thick / 2, _WIDTH_M / 2, 0))
    room.place(make_slab, [thick, _WIDTH_M, _HEIGHT_M], left)


def _add_rack_and_pumps(room: RoomBuilder) -> None:
    """Adds pipes along the back wall, each down to a pump and up again to a header."""
    low, front, header = 0.5, 4.8, 2.8
    radius = _RACK_RADII_M[0]
    ends = [(x, front - 1.4, header + radius) for x in (1.6, 9.6)]
    add_pipe_run(room, ends, radius, stem=(0, -1, 0))
    for k, radius in enumerate(_RACK_RADII_M):
        x, y, z = 9.3 - 1.0 * k, 6.6 - 0.4 * (k % 2), 2.85 - 0.42 * (k // 2)
        corners = [(0.9, y, z), (x, y, z), (x, y, low), (x, front, low)]
        add_pipe_run(room, corners, radius, stem=(1, 0, 0), valves={1})
        add_pipe_run(
            room,
            [(x, front - 0.9, low), (x, front - 1.4, low), (x, front - 1.4, header)],
            radius,
            stem=(0, -1, 0),
            valves={1},
        )
        body = 2.2 * radius + 0.06
        motor = pose((x, front - 0.05, low), (0, -1, 0))
        room.place(make_motor, [body, 0.6], motor)
        base = pose((x, front - 0.4, 0))
        room.place(make_slab, [2.4 * body, 0.8, low - body], base)


def _add_rack_posts(room: RoomBuilder) -> None:
    """Adds posts along the back wall, with an arm below the uppermost pipes."""
    for k in range(9):
        x = 0.6 + 1.0 * k
        room.place(make_slab, [0.06, 0.06, 3.1], pose((x, 6.95, 0)))
        top = 2.85 - max(_RACK_RADII_M)
        room.place(make_slab, [0.05, 0.82, 0.05], pose((x, 6.5, top - 0.05)))


def _add_risers(room: RoomBuilder) -> None:
    """Adds pipes up the left wall, with valves at hand height."""
    for k, radius in enumerate(_RISER_RADII_M):
        y = 0.8 + 0.62 * k
        corners = [(0.35, y, 0.05), (0.35, y, 2.7), (1.1, y, 2.7)]
        add_pipe_run(room, corners, radius, stem=(1, 0, 0), valves={0})


def _add_tanks(room: RoomBuilder) -> None:
    for x, radius, height in ((8.9, 0.6, 2.2), (7.4, 0.6, 2.2), (6.1, 0.45, 1.8)):
        y = 2.2
        room.place(make_tank, [radius, height], pose((x, y, 0.3)))
        for dx, dy in ((-0.6, -0.6), (-0.6, 0.6), (0.6, -0.6), (0.6, 0.6)):
            leg = pose((x + dx * radius, y + dy * radius, 0))
            room.place(make_slab, [0.08, 0.08, 0.5], leg)
        ladder = pose((x - 0.2, y - radius - 0.12, 0))
        room.place(make_ladder, [2.4, 0.4, 8, 0.02], ladder)


def _add_cabinets(room: RoomBuilder) -> None:
    for k in range(8):
        x = 1.6 + 0.62 * k
        room.place(make_cabinet, [0.6, 0.45, 1.9], pose((x, 0.7, 0)))
        handle = pose((x + 0.22, 0.7 - 0.225 + 0.012, 0.95), (0, -1, 0), (0, 0, 1))
        room.place(make_handle, [0.18, 0.045, 0.007], handle)


def _add_railings(room: RoomBuilder) -> None:
    """Adds railings before the tanks: ladders on their side."""
    for k in range(4):
        side = pose((5.4 + 1.15 * k, 1.0, 0.5), (1, 0, 0), (0, 0, 1))
        room.place(make_ladder, [1.1, 0.5, 3, 0.02], side)


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
        room: The room to add to.
        corners: (k, 3) corners of the axis, m; consecutive lines are at right angles.
        radius: Radius of the pipe, m.
        stem: (3,) unit direction of the valves' stems, normal to the valves' pipes.
        valves: Indices of the straight parts that have a valve in their middle.
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
    """Adds spools of equal length in a row, with flanges where they meet."""
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
    """Adds a flange from `neck` along u, and the nuts on its back."""
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
    """Adds a valve's body from `start` along u, with bonnet and wheel along `stem`."""
    middle = start + valve_length(radius) / 2 * u
    room.place(make_valve_body, [radius], pose(start, u, stem))
    room.place(make_bonnet, [radius], pose(middle, stem, u))
    wheel = 2.4 * radius + 0.03
    room.place(make_handwheel, [wheel], pose(middle + 8.0 * radius * stem, stem, u))


def _normal_to(u: np.ndarray) -> np.ndarray:
    """Returns a unit vector normal to u, which is along an axis."""
    return np.roll(np.abs(u), 1)


def make_tube(radius: float, bottom: float, top: float, reach: float) -> Surface:
    """Returns a tube that comes from +y, runs up along z and leaves to +y.

    Its front, at y = 0, is from z = `bottom` to z = `top`.

    Args:
        radius: Radius, m.
        bottom: Height of the front's lower end, m.
        top: Height of the front's upper end, m.
        reach: Reach of its ends behind the front, m.
    """
    corners = np.array([(reach, bottom), (radius, bottom), (radius, top), (reach, top)])
    corners = np.column_stack([np.zeros(4), corners])
    path = rounded_path(corners, 3 * radius, bend_steps=6)
    return sweep_tube(path, np.array([1.0, 0.0, 0.0]), radius, 16)


def add_instrument_panel(room: RoomBuilder) -> None:
    """Adds a panel with tubes before it, between two struts that end in their plane."""
    low, high = _TUBE_Z_M
    half_row = _SPACING_M * (NUM_TUBES + 1) / 2
    behind = FRONT_Y_M + 0.1
    panel = pose((PANEL_X_M, behind + 0.02, 0.6))
    room.place(make_slab, [0.7, 0.01, 1.3], panel)
    for side in (-1, 1):
        strut = pose((PANEL_X_M + side * half_row, FRONT_Y_M + 0.05, low - 0.05))
        room.place(make_slab, [0.016, 0.1, high - low + 0.1, 0.002], strut)
    for k in range(NUM_TUBES):
        x = PANEL_X_M + (k + 1) * _SPACING_M - half_row
        radius = _TUBE_RADII_M[k % len(_TUBE_RADII_M)]
        tube = pose((x, FRONT_Y_M, 0))
        room.place(make_tube, [radius, low, high, 0.1], tube)
