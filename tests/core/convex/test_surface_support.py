"""A surface is felt from its own side alone, at concave edges and corners too."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from cell_mesh import cell_mesh
from contact_samples import box, hull, spike
from scipy.spatial.transform import Rotation
from solid_surface import Surface

from drake_haptics import _core
from drake_haptics.geometry.mesh.mesh import Mesh

CELL = 0.02
T = 2e-3


def cube_with_a_notch() -> Mesh:
    """A cube of 2 × 2 × 2 cells without its farthest: at (1, 1, 1) a hollow corner."""
    return cell_mesh(set(product((0, 1), repeat=3)) - {(1, 1, 1)}, CELL)


TOOLS = {
    "ball": hull(
        1e-3 * Rotation.random(60, random_state=1).apply([[0.0, 0.0, 1.0]] * 60)
    ),
    "box": box([2e-3, 3e-3, 4e-3]),
    "spike": spike([0, 0, 0]),
}


@pytest.mark.parametrize("along", [0.0, 0.5], ids=["corner", "edge"])
@pytest.mark.parametrize("tool", TOOLS)
def test_no_contact_from_behind_a_hollow_edge(tool: str, along: float) -> None:
    """A tool wholly inside the solid: seen from there, hollow edges are ridges."""
    mesh = cube_with_a_notch()
    surface = Surface(mesh)
    solid = _core.decompose_surface(
        mesh.vertices, mesh.triangles, np.ones(len(mesh.triangles), dtype=np.uint8)
    )
    rng = np.random.default_rng(0)
    V = TOOLS[tool].vertices
    looked = 0
    while looked < 100:
        R = Rotation.random(random_state=rng)
        p_WV = R.apply(V)
        # One of the tool's vertices is on the far side of the edge, within reach.
        p_W = CELL * (np.ones(3) + along * np.roll([1.0, 0, 0], looked % 3))
        behind = -np.where(np.roll([along > 0, False, False], looked % 3), 0, 1)
        p_W += rng.uniform(0.2e-3, 1.5e-3) * (behind + 0.3 * rng.normal(size=3))
        p_WT = p_W - p_WV[np.argmax(p_WV @ -behind)]
        if not surface.holds(p_WV + p_WT).all():
            continue
        looked += 1
        x, y, z, w = R.as_quat()
        tracker = _core.SceneTracker(TOOLS[tool], [solid], T)
        contacts = tracker.query(np.array([w, x, y, z, *p_WT]))
        for p_WCb, n in zip(contacts.p_WCb, contacts.nhat_BA_W, strict=True):
            assert surface.facing(p_WCb, n) > -1e-3
