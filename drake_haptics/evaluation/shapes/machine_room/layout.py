"""Where everything in the machine room is."""

from __future__ import annotations

from drake_haptics.evaluation.shapes.machine_room.equipment import (
    make_cabinet,
    make_handle,
    make_ladder,
    make_motor,
    make_slab,
    make_tank,
)
from drake_haptics.evaluation.shapes.machine_room.instrument_panel import (
    add_instrument_panel,
)
from drake_haptics.evaluation.shapes.machine_room.pipe_run import add_pipe_run
from drake_haptics.evaluation.shapes.machine_room.room import (
    MachineRoom,
    RoomBuilder,
    pose,
)

_LENGTH_M, _WIDTH_M, _HEIGHT_M = 10.0, 7.0, 3.2
# Radii of the pipes on the rack along the back wall, m.
_RACK_RADII_M = (0.084, 0.057, 0.057, 0.044, 0.030, 0.030, 0.024, 0.024)
# Radii of the risers along the left wall, m.
_RISER_RADII_M = (0.057, 0.044, 0.044, 0.030, 0.030, 0.024)


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
    """Pipes along the back wall, each down to a pump and up again to a header."""
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
    """Posts along the back wall, with an arm below the uppermost pipes."""
    for k in range(9):
        x = 0.6 + 1.0 * k
        room.place(make_slab, [0.06, 0.06, 3.1], pose((x, 6.95, 0)))
        top = 2.85 - max(_RACK_RADII_M)
        room.place(make_slab, [0.05, 0.82, 0.05], pose((x, 6.5, top - 0.05)))


def _add_risers(room: RoomBuilder) -> None:
    """Pipes up the left wall, with valves at hand height."""
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
    """Railings are ladders on their side, before the tanks."""
    for k in range(4):
        side = pose((5.4 + 1.15 * k, 1.0, 0.5), (1, 0, 0), (0, 0, 1))
        room.place(make_ladder, [1.1, 0.5, 3, 0.02], side)
