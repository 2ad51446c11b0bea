"""Test on real shapes that no contact jumps into depth from tick to tick."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh
from drake_haptics.models import FOLDER

MESHES = FOLDER / "meshes"


def pieces(name: str) -> _core.ConvexPieces:
    return decompose(load_mesh(MESHES / name, scale=1.0)).core


@pytest.mark.parametrize("reach", [0.0, 1e-3, 2e-3])
@pytest.mark.parametrize("lift", [0.0, 7e-3])
def test_a_spoon_dragged_through_a_cup_wall_never_jumps(
    reach: float, lift: float
) -> None:
    """The spoon's pieces pass seams, rims and the back of the outer wall's pieces.

    The largest displacement of a point of the spoon is known each tick. The deepest
    contact may sink by little more than that, and by a quarter of the tolerance where
    the tool comes into reach of a piece from its side.
    """
    tool, cup = pieces("spoon.obj"), pieces("cup.obj")
    tolerance = 1e-3
    tracker = _core.SceneTracker(tool, [cup], tolerance)
    vertices = tool.vertices
    last, deepest = None, tolerance
    worst, seen = 0.0, 0
    turn = Rotation.from_euler("xyz", [0, 60, 0], degrees=True)
    for angle in np.linspace(0, 2 * np.pi, 4000):
        R = Rotation.from_rotvec([0, 0, angle]) * turn
        x, y, z, w = R.as_quat()
        tip = R.apply(vertices)
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        # The spoon's outermost point follows the cup's inner wall, `reach` inside.
        p = out * (0.031 + reach - (tip @ out).max())
        p[2] = 0.02 + lift - tip[:, 2].min()
        placed = tip + p
        moved = 0.0 if last is None else np.linalg.norm(placed - last, axis=1).max()
        contacts = tracker.query(np.concatenate([[w, x, y, z], p]))
        now = contacts.distance.min(initial=tolerance)
        if last is not None:
            worst = max(worst, deepest - now - 3 * moved)
            seen += now < 0
        last, deepest = placed, now
    assert seen > 500
    assert worst < 0.25 * tolerance
