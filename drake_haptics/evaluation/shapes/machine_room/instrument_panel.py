"""A panel of instrument tubes, and the way of a wrench across it."""

from __future__ import annotations

import numpy as np

from drake_haptics.evaluation.shapes.machine_room.equipment import make_slab
from drake_haptics.evaluation.shapes.machine_room.room import RoomBuilder, pose
from drake_haptics.evaluation.shapes.machine_room.wrench import HALF_THICKNESS_M
from drake_haptics.evaluation.shapes.surface import Surface
from drake_haptics.evaluation.shapes.sweep import rounded_path, sweep_tube

NUM_TUBES = 15
_SPACING_M = 0.0235
_TUBE_RADII_M = (0.008, 0.006, 0.007)
# The fronts of tubes and struts are in one plane, which faces -y.
_FRONT_Y_M = 3.3
_PANEL_X_M = 2.0
_TUBE_Z_M = (0.9, 1.6)


def make_tube(radius: float, bottom: float, top: float, reach: float) -> Surface:
    """Returns a tube that comes from +y, runs up along z and leaves to +y.

    Its front, at y = 0, is from z = `bottom` to z = `top`.

    Args:
        radius: m.
        bottom: m.
        top: m.
        reach: of its ends behind the front, m.
    """
    corners = np.array([(reach, bottom), (radius, bottom), (radius, top), (reach, top)])
    corners = np.column_stack([np.zeros(4), corners])
    path = rounded_path(corners, 3 * radius, bend_steps=6)
    return sweep_tube(path, np.array([1.0, 0.0, 0.0]), radius, 16)


def add_instrument_panel(room: RoomBuilder) -> None:
    """Adds a panel with tubes before it, between two struts, which are as proud."""
    low, high = _TUBE_Z_M
    half_row = _SPACING_M * (NUM_TUBES + 1) / 2
    behind = _FRONT_Y_M + 0.1
    panel = pose((_PANEL_X_M, behind + 0.02, 0.6))
    room.place(make_slab, [0.7, 0.01, 1.3], panel)
    for side in (-1, 1):
        strut = pose((_PANEL_X_M + side * half_row, _FRONT_Y_M + 0.05, low - 0.05))
        room.place(make_slab, [0.016, 0.1, high - low + 0.1, 0.002], strut)
    for k in range(NUM_TUBES):
        x = _PANEL_X_M + (k + 1) * _SPACING_M - half_row
        radius = _TUBE_RADII_M[k % len(_TUBE_RADII_M)]
        tube = pose((x, _FRONT_Y_M, 0))
        room.place(make_tube, [radius, low, high, 0.1], tube)


def wrench_path(num_poses: int) -> np.ndarray:
    """Returns a way of the wrench across the tubes and struts.

    It comes near, presses 0.2 mm into the 17 of them, slides up along the tubes by
    150 mm while it rocks a little, and leaves. In 3 s nothing moves faster than
    0.15 m/s.

    Args:
        num_poses: at equal times.

    Returns:
        X_WTool (num_poses, 4, 4).
    """
    s = np.linspace(0, 1, num_poses)
    press = np.clip(np.minimum(s, 1 - s) / 0.2, 0, 1)
    press = press**2 * (3 - 2 * press)
    away = 0.012 * (1 - press) - 0.0002 * press
    slide = np.clip((s - 0.2) / 0.6, 0, 1)
    rock = 2e-3 * press * np.sin(6 * np.pi * slide)
    # The tool's -z faces the tubes, along +y; its x is along the row of tubes.
    c, n, zero = np.cos(rock), np.sin(rock), np.zeros(num_poses)
    path = np.tile(np.eye(4), (num_poses, 1, 1))
    path[:, :3, 0] = np.column_stack([c, n, zero])
    path[:, :3, 1] = [0, 0, 1]
    path[:, :3, 2] = np.column_stack([n, -c, zero])
    path[:, 0, 3] = _PANEL_X_M
    path[:, 1, 3] = _FRONT_Y_M - HALF_THICKNESS_M - away
    path[:, 2, 3] = 1.15 + 0.15 * slide**2 * (3 - 2 * slide)
    return path
