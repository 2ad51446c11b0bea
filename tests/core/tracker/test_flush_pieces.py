"""The plane of a facet that lies flush beside another piece ends with its surface."""

from __future__ import annotations

import numpy as np
import pytest
from press_tools import MODELS, make_tools
from scipy.spatial.transform import Rotation

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh

TOLERANCE_M = 2e-3
GAP_M = 1.7e-3
# Normal of a flat part of the spoon's round bowl: two triangles of two pieces.
NORMAL_T = np.array([-0.17399, 0.0, -0.98475])


def test_no_contact_is_nearer_than_the_lowest_vertex_of_a_rolling_spoon():
    block = load_mesh(MODELS / "block.obj", scale=1.0)
    tool = make_tools()["spoon"]
    tracker = _core.SceneTracker(tool.core, [decompose(block).core], TOLERANCE_M)
    low, high = block.vertices.min(axis=0), block.vertices.max(axis=0)
    above = np.append((low + high)[:2] / 2, high[2] + GAP_M)
    level, _ = Rotation.align_vectors([[0, 0, -1]], [NORMAL_T])
    V = np.array(tool.mesh.vertices)
    for tilt_x in np.radians(np.arange(-1.0, 1.01, 0.1)):
        for tilt_y in np.radians(np.arange(-1.0, 1.01, 0.1)):
            turn = Rotation.from_rotvec([tilt_x, tilt_y, 0.0]) * level
            corners = turn.apply(V)
            p = above - corners[np.argmin(corners[:, 2])]
            q = np.concatenate([np.roll(turn.as_quat(), 1), p])
            tracker.reset()
            tracker.query(q + np.eye(7)[6] * 5e-3)
            least_m = tracker.query(q).distance.min()
            assert least_m == pytest.approx(GAP_M, abs=1e-8), (tilt_x, tilt_y)
