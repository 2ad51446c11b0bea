"""Tools that slide over surfaces at a held pose, and the force that they would feel."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from contact_samples import hull
from press_rig import PERIOD_S, Gains
from scipy.spatial.transform import Rotation
from wrench_chain import cluster, push

from drake_haptics import _core
from drake_haptics.geometry.mesh.mesh import Mesh

STEP_M = 1e-4  # of a slide, in a tick: 0.1 m/s
_APPROACH_M = 4e-3


def make_slide_tools() -> dict[str, _core.ConvexPieces]:
    """Convex tools whose lowest feature is at the origin, all of it above z = 0."""
    ball = Rotation.random(200, random_state=1).apply([0.0, 0.0, 6e-3])
    cube = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0, 2)])
    turn = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    edge = [[x, y, z] for x in (-6e-3, 6e-3) for y, z in ((0, 0), (-4e-3, 9e-3))]
    edge += [[x, 5e-3, 7e-3] for x in (-6e-3, 6e-3)]
    return {
        "box": hull(cube * [6e-3, 4e-3, 3e-3]),
        "wide box": hull(cube * [16e-3, 12e-3, 3e-3]),
        "ball": hull(ball - [0, 0, ball[:, 2].min()]),
        "spike": hull(np.concatenate([ring * 3e-3 + [0, 0, 0.03], [[0, 0, 0]]])),
        "edge": hull(edge),
    }


def cut(mesh: Mesh, piece_of_triangle: object) -> _core.ConvexPieces:
    """Returns a mesh in chosen pieces: any numbers, one for a piece."""
    _, labels = np.unique(np.asarray(piece_of_triangle), return_inverse=True)
    return _core.assemble_surface_pieces(
        mesh.vertices, mesh.triangles, labels.astype(np.int32)
    )


def slide(
    tool: _core.ConvexPieces,
    solid: _core.ConvexPieces,
    path_W: np.ndarray,
    nhat_W: np.ndarray,
    R_WT: np.ndarray,
    tolerance_m: float,
) -> Iterator[_core.ContactSet]:
    """Comes down onto a path along its normal, then follows it.

    Args:
        tool: Tool of one or more pieces.
        solid: Solid that is fixed at the world's origin.
        path_W: (n, 3) origin of the tool, tick by tick, m.
        nhat_W: (3,) outward normal where the path begins.
        R_WT: (3, 3) orientation of the tool, held.
        tolerance_m: Tolerance of the contact query, m.

    Yields:
        The contacts at each point of the path.
    """
    x, y, z, w = Rotation.from_matrix(R_WT).as_quat()
    tracker = _core.SceneTracker(tool, [solid], tolerance_m)
    for height in np.arange(_APPROACH_M, 0, -STEP_M):
        tracker.query(np.array([w, x, y, z, *(path_W[0] + height * nhat_W)]))
    for p in path_W:
        yield tracker.query(np.array([w, x, y, z, *p]))


def line(start_W: object, end_W: object) -> np.ndarray:
    """The points (n, 3) of a straight path, STEP_M apart."""
    start, end = np.asarray(start_W, float), np.asarray(end_W, float)
    count = max(2, round(float(np.linalg.norm(end - start)) / STEP_M) + 1)
    return np.linspace(start, end, count)


@dataclass(frozen=True)
class Felt:
    """The force of a tick.

    Attributes:
        force_W: (3,) force on the tool, of all clusters together, N.
        clusters: Number of clusters.
    """

    force_W: np.ndarray
    clusters: int


def feel(
    contacts: _core.ContactSet, method: str, gains: Gains, v_WT: np.ndarray
) -> Felt:
    """Returns the force of the project's chain for a tool that moves at v_WT."""
    clusters = cluster(contacts, method, gains.tolerance_m, gains.delta_m)
    V_WT = np.concatenate([np.zeros(3), v_WT])
    F_To_W = push(
        clusters, gains.stiffness_N_per_m, gains.damping_Ns_per_m, V_WT=V_WT
    ).F_To_W
    return Felt(np.array(F_To_W[3:]), len(clusters))


def velocity(path_W: np.ndarray) -> np.ndarray:
    """Returns the velocity of a straight path, (3,), m/s."""
    return (path_W[1] - path_W[0]) / PERIOD_S
