"""A bolt like M16 that is turned through a nut, made here with a known play."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh
from box_scenes import write_scene
from degenerate_scenes import MASS_KG, PERIOD_S, Run, record
from fake_device import FreeHandle, make_reading

from drake_haptics.device.backend import DeviceReading
from drake_haptics.scene.schema import ContactParameters, Scene, Waypoint

PITCH_M = 2e-3  # and lead
MAJOR_M = 8e-3  # radius at the bolt's crest
DEPTH_M = 1e-3  # of the thread
PLAY_M = 1e-4  # along the radius
# A flank climbs a quarter of the pitch: its normal's share along the axis.
AXIAL_SHARE = DEPTH_M / np.hypot(DEPTH_M, PITCH_M / 4)
AXIAL_PLAY_M = PLAY_M * (PITCH_M / 4) / DEPTH_M
# Height of the profile at shares of the pitch: root, flank, crest, flank.
_SHARES = np.array([0.0, 0.25, 0.5, 0.75])
_HEIGHTS = np.array([0.0, 0.0, 1.0, 1.0])
# Each law with values that fit the play.
CONTACTS = {
    "penalty": ContactParameters(
        tolerance_m=3e-5, stiffness_N_per_m=2e5, damping_Ns_per_m=5.0
    ),
    "constraint": ContactParameters(law="constraint", skin_m=2e-5),
}
# How long a handle rests before it turns.
TURNER_WAIT_S = 0.05


def _make_rows(
    turns: int, offset_m: float, segments: int
) -> tuple[np.ndarray, np.ndarray, list[list[int]]]:
    """Vertices (n, 3), m, their grid (rows, segments + 1), and triangles outward.

    Going once round one is a pitch higher: the last column is the first, a pitch up.
    """
    per_pitch = len(_SHARES)
    rows = turns * per_pitch + 1
    k = np.arange(rows + per_pitch)
    z = PITCH_M * (k // per_pitch + _SHARES[k % per_pitch])
    r = MAJOR_M - DEPTH_M + DEPTH_M * _HEIGHTS[k % per_pitch] + offset_m
    turn = 2 * np.pi * np.arange(segments) / segments
    j = np.arange(segments)
    points = np.stack(
        np.broadcast_arrays(
            r[:, None] * np.cos(turn),
            r[:, None] * np.sin(turn),
            z[:, None] + PITCH_M * j / segments,
        ),
        axis=-1,
    ).reshape(-1, 3)
    index = np.arange(len(k) * segments).reshape(len(k), segments)
    grid = np.column_stack([index[:rows], index[per_pitch : rows + per_pitch, 0]])
    quads = [
        (grid[a, b], grid[a, b + 1], grid[a + 1, b + 1], grid[a + 1, b])
        for a in range(rows - 1)
        for b in range(segments)
    ]
    triangles = [t for p, q, s, u in quads for t in ([p, q, s], [p, s, u])]
    return points, grid, triangles


def make_bolt(turns: int, segments: int = 36) -> trimesh.Trimesh:
    """A threaded rod, closed by two fans; its axis is z."""
    points, grid, triangles = _make_rows(turns, 0.0, segments)
    per_pitch = len(_SHARES)
    # Down at the seam from the end of the row to its beginning.
    bottom = [*grid[0, :-1], *(grid[i, 0] for i in range(per_pitch, 0, -1))]
    top = [*grid[-1], *(grid[-1 - i, -1] for i in range(1, per_pitch))]
    centers = len(points) + np.arange(2)
    z = points[:, 2]
    points = np.vstack([points, [0, 0, z[bottom].mean()], [0, 0, z[top].mean()]])
    for loop, center, sign in ((bottom, centers[0], -1), (top, centers[1], 1)):
        for a, b in zip(loop, [*loop[1:], loop[0]], strict=True):
            triangles.append([center, a, b][::sign])
    mesh = trimesh.Trimesh(points, triangles, process=True)
    mesh.remove_unreferenced_vertices()
    return mesh


def make_thread(
    turns: int, offset_m: float, segments: int = 36
) -> tuple[np.ndarray, np.ndarray]:
    """A thread, farther out by an offset: vertices (n, 3), m, and triangles (m, 3)."""
    points, _, triangles = _make_rows(turns, offset_m, segments)
    used, index = np.unique(triangles, return_inverse=True)
    return points[used], index.reshape(-1, 3)


def make_nut(turns: int, play_m: float = PLAY_M) -> trimesh.Trimesh:
    """The inner surface of a nut, open: its thread, farther out by a radial play."""
    points, triangles = make_thread(turns, play_m)
    return trimesh.Trimesh(points, triangles[:, ::-1], process=True)


class Turner(FreeHandle):
    """A handle that is turned about the nut's axis and stays at its height."""

    def __init__(self, turns: float, turns_per_s: float):
        super().__init__(self._turn)
        self._turns, self._rate = turns, turns_per_s

    def _turn(self, call: int) -> DeviceReading:
        """The next angle; at first, and at the end, it rests."""
        elapsed_s = max(0.0, call * PERIOD_S - TURNER_WAIT_S)
        half = np.pi * min(self._turns, self._rate * elapsed_s)
        wxyz = (np.cos(half), 0, 0, np.sin(half))
        reading = make_reading(call, position=(0, 0, -PITCH_M), wxyz=wxyz)
        if 0 < elapsed_s < self._turns / self._rate:
            reading.V_BH[2] = 2 * np.pi * self._rate
        return reading


def make_thread_scene(contact: ContactParameters, folder: Path) -> Scene:
    """A bolt of five turns in a nut of two, with its meshes in a folder."""
    return write_scene(
        folder,
        make_bolt(5),
        {"nut": make_nut(2)},
        [Waypoint(0.0, [0.0, 0.0, -PITCH_M])],
        contact=contact,
        mass_kg=MASS_KG,
    )


def turn_bolt(
    contact: ContactParameters, turns: float, turns_per_s: float, folder: Path
) -> Run:
    """Turns the bolt by its handle through the nut.

    The handle does not go along: what the thread moves, the coupling pulls back.
    """
    duration_s = turns / turns_per_s + TURNER_WAIT_S + 0.1
    scene = make_thread_scene(contact, folder)
    return record(scene, Turner(turns, turns_per_s), duration_s)
