"""Scenes of degenerate contact, and a handle that leads a tool through each.

After K. Erleben, "Methodology for assessing mesh-based contact point methods", ACM
Transactions on Graphics 37(3), 2018, section 5: spikes, wedges, cracks, holes, sliding,
cliff edges and internal edges, where vertices and edges meet that have no one normal.
The shapes are made here, of centimeters, and a handle presses instead of gravity.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, product
from pathlib import Path

import numpy as np
import trimesh
from box_scenes import write_scene
from cell_mesh import cell_mesh
from fake_device import FreeHandle, make_reading
from minkowski_truth import place, signed_distance
from scipy.spatial.transform import Rotation

from drake_haptics.device.backend import DeviceBackend, DeviceReading
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import ContactParameters, Pose, Scene, Waypoint
from drake_haptics.simulation.run import run

PERIOD_S = 1e-3
MASS_KG = 0.05
SPEED_M_PER_S = 0.05
CELL_M = 4e-3
# How far above its place in contact a tool begins, and how far below the handle goes.
ABOVE_M, BELOW_M = 1e-2, 8e-3
HOLD_S = 0.1

# Half width over height of a spike, and of a wedge across its ridge.
_HALF_M, _HEIGHT_M = 5e-3, 15e-3
SLOPE = _HALF_M / np.hypot(_HALF_M, _HEIGHT_M)  # sine of half the angle at the tip


def box(low: object, high: object) -> np.ndarray:
    """Corners (8, 3) of a box, m."""
    return np.array(list(product(*zip(low, high, strict=True))), float)


# Tips and ridges are at the origin, the shapes above them; a floor is below z = 0.
SPIKE = np.concatenate(
    [[[0, 0, 0]], box([-_HALF_M, -_HALF_M, _HEIGHT_M], [_HALF_M, _HALF_M, 0.018])]
)
WEDGE = np.concatenate(
    [
        [[-_HALF_M, 0, 0], [_HALF_M, 0, 0]],
        box([-_HALF_M, -_HALF_M, _HEIGHT_M], [_HALF_M, _HALF_M, 0.018]),
    ]
)
CUBE = box([-_HALF_M, -_HALF_M, 0], [_HALF_M, _HALF_M, 2 * _HALF_M])
FLOOR = box([-0.03, -0.03, -0.01], [0.03, 0.03, 0])
_DOWN = np.diag([1.0, -1.0, -1.0])
_ACROSS = np.array([[0, -1.0, 0], [1, 0, 0], [0, 0, 1]])


@dataclass(frozen=True, eq=False)
class DegenerateScene:
    """A tool, the solid that it meets, and the handle's way.

    Attributes:
        tool: (n, 3) vertices of a convex tool, m; the tool's frame is the world's where
            the shapes touch.
        parts: Convex parts that make up the solid, each (m, 3), m.
        way_W: (k, 3) corners of the handle's way from that place, m; it begins and ends
            above, and stands still for a while at the corners between.
        least_rise: Sine of the least angle between a normal of contact and the plane
            across the press: 1 where the press is along the normal.
        cells: Cells of CELL_M that make up the parts, where these are one body.
    """

    tool: np.ndarray
    parts: tuple[np.ndarray, ...]
    way_W: np.ndarray
    least_rise: float = 1.0
    cells: tuple[tuple[int, int, int], ...] = ()


def _press(x: float = 0.0, y: float = 0.0) -> np.ndarray:
    """A way straight down, and up again, at (x, y), m."""
    return np.array([[x, y, ABOVE_M], [x, y, -BELOW_M], [x, y, ABOVE_M]])


def _slide(start: float, end: float) -> np.ndarray:
    """A way down, along x, and up, m."""
    low = -BELOW_M / 2
    return np.array(
        [[start, 0, ABOVE_M], [start, 0, low], [end, 0, low], [end, 0, ABOVE_M]]
    )


def _cells(
    cells: tuple[tuple[int, int, int], ...], low: object
) -> tuple[np.ndarray, ...]:
    """Cubes of CELL_M on a grid whose lowest corner is `low`, m."""
    corner = np.array(low)
    return tuple(
        box(corner + CELL_M * np.array(c), corner + CELL_M * (np.array(c) + 1))
        for c in cells
    )


_RING = tuple((i, j, 0) for i, j in product(range(3), range(3)) if (i, j) != (1, 1))
_GROOVE = tuple(c for c in product(range(3), range(3), range(2)) if c[1:] != (1, 1))
# A spike or wedge stands on the two rims of a gap of one cell at this depth.
_SUNK_M = CELL_M / 2 * _HEIGHT_M / _HALF_M
_HOLE = _cells(_RING, [-1.5 * CELL_M, -1.5 * CELL_M, _SUNK_M - CELL_M])
_CRACK = _cells(_GROOVE, [-1.5 * CELL_M, -1.5 * CELL_M, _SUNK_M - 2 * CELL_M])
_TILES = tuple(product(range(15), range(5), (0,)))
_TILED = box([-7.5 * CELL_M, -2.5 * CELL_M, -CELL_M], [7.5 * CELL_M, 2.5 * CELL_M, 0])
_BLOCKS = tuple(
    box([x, -0.02, -0.01], [x + 0.01, 0.02, 0]) for x in np.arange(-0.03, 0.03, 0.01)
)

SCENES = {
    "spikes, tip on tip": DegenerateScene(SPIKE, (SPIKE @ _DOWN,), _press()),
    "spike on the ridge of a wedge": DegenerateScene(
        SPIKE, (WEDGE @ _DOWN,), _press(1e-3), SLOPE
    ),
    "wedges, ridge across ridge": DegenerateScene(
        WEDGE, (WEDGE @ _ACROSS.T @ _DOWN,), _press(5e-4, -5e-4)
    ),
    "spike in a hole": DegenerateScene(SPIKE, _HOLE, _press(), SLOPE, _RING),
    "spike in a crack": DegenerateScene(SPIKE, _CRACK, _press(), SLOPE, _GROOVE),
    "wedge in a crack": DegenerateScene(WEDGE, _CRACK, _press(), SLOPE, _GROOVE),
    "sliding spike": DegenerateScene(SPIKE, (FLOOR,), _slide(-0.01, 0.01)),
    "sliding wedge": DegenerateScene(WEDGE, (FLOOR,), _slide(-0.01, 0.01)),
    "cliff edges": DegenerateScene(CUBE, (FLOOR - [0.03 + _HALF_M, 0, 0],), _press()),
    "internal edges": DegenerateScene(
        CUBE, (_TILED,), _slide(-0.012, 0.012), cells=_TILES
    ),
    "internal edges, each block an object": DegenerateScene(
        CUBE, _BLOCKS, _slide(-0.012, 0.012)
    ),
}


def make_scene(
    case: DegenerateScene, contact: ContactParameters, folder: Path
) -> Scene:
    """The scene, with its meshes in a folder; parts of one solid are one object."""
    hull = trimesh.convex.convex_hull
    solids = [hull(part) for part in case.parts]
    if case.cells:
        mesh = cell_mesh(case.cells, CELL_M)
        low = np.min([part.min(axis=0) for part in case.parts], axis=0)
        solids = [trimesh.Trimesh(mesh.vertices + low, mesh.triangles)]
    return write_scene(
        folder,
        hull(case.tool),
        {f"part_{i}": solid for i, solid in enumerate(solids)},
        [Waypoint(0.0, case.way_W[0].tolist())],
        contact=contact,
        mass_kg=MASS_KG,
    )


class Handle(FreeHandle):
    """A handle that goes along a way, one step at each reading."""

    def __init__(self, way_W: np.ndarray):
        super().__init__(self._find_place)
        points = [np.repeat(way_W[:1], 20, axis=0)]
        for start, end in pairwise(way_W):
            length = float(np.linalg.norm(end - start))
            count = round(length / (SPEED_M_PER_S * PERIOD_S))
            points.append(
                start + np.linspace(0, 1, count + 1)[1:, None] * (end - start)
            )
            points.append(np.repeat(end[None], round(HOLD_S / PERIOD_S), axis=0))
        self.p_WH = np.concatenate(points)

    def _find_place(self, call: int) -> DeviceReading:
        k = min(call, len(self.p_WH)) - 1
        v = (self.p_WH[k] - self.p_WH[max(k - 1, 0)]) / PERIOD_S
        return make_reading(call, position=self.p_WH[k], velocity=v)


@dataclass(frozen=True)
class Run:
    """The motion and the wrenches of a run, tick by tick.

    Attributes:
        X_WT: (n, 7) poses of the tool.
        X_WH: (n, 7) poses of the handle.
        F_To_W: (n, 6) wrench of contact on the tool at To, N·m and N.
        F_Ho_W: (n, 6) wrench asked of the device, N·m and N.
    """

    X_WT: np.ndarray
    X_WH: np.ndarray
    F_To_W: np.ndarray
    F_Ho_W: np.ndarray

    @property
    def work_J(self) -> np.ndarray:
        """(n,) work of contact on the tool so far, J, by the trapezoidal rule."""
        turned = Rotation.from_quat(self.X_WT[:, [1, 2, 3, 0]])
        step = np.column_stack(
            [
                (turned[1:] * turned[:-1].inv()).as_rotvec(),
                np.diff(self.X_WT[:, 4:], axis=0),
            ]
        )
        mean = (self.F_To_W[1:] + self.F_To_W[:-1]) / 2
        return np.concatenate([[0.0], np.cumsum((mean * step).sum(axis=1))])


def run_scene(case: DegenerateScene, contact: ContactParameters, folder: Path) -> Run:
    """Runs a scene through the package's own loop, the handle as a device."""
    handle = Handle(case.way_W)
    duration_s = len(handle.p_WH) * PERIOD_S
    return record(make_scene(case, contact, folder), handle, duration_s)


def record(scene: Scene, handle: DeviceBackend, duration_s: float) -> Run:
    """Runs a scene whose handle is a device that knows where it is in the world."""
    scene.device.base = Pose()
    haptic = BuildHapticDiagram(scene, device=handle)
    names = "X_WT", "X_WH", "F_To_W", "F_Ho_W_commanded"
    ports = [haptic.diagram.GetOutputPort(name) for name in names]
    rows: list[list[np.ndarray]] = [[] for _ in ports]

    def look(context: object) -> None:
        for row, port in zip(rows, ports, strict=True):
            row.append(port.Eval(context).copy())

    run(haptic, duration_s, on_tick=look)
    return Run(*map(np.array, rows))


def exact_distances(case: DegenerateScene, X_WT: np.ndarray) -> Iterator[float]:
    """The exact signed distance of tool and solid at each of some poses (n, 7), m.

    In overlap it is that of the convex part which is deepest in the tool: no more than
    how deep the solid is.
    """
    for q in X_WT:
        X = np.eye(4)
        X[:3, :3] = Rotation.from_quat(q[[1, 2, 3, 0]]).as_matrix()
        X[:3, 3] = q[4:]
        tool_W = place(case.tool, X)
        near = [
            part
            for part in case.parts
            if np.all(part.min(axis=0) - tool_W.max(axis=0) < 3e-3)
            and np.all(tool_W.min(axis=0) - part.max(axis=0) < 3e-3)
        ]
        yield min((signed_distance(tool_W, part) for part in near), default=np.inf)
