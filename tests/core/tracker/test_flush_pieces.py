"""Facets of two pieces that lie flush act as one, which ends with its surface."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import box
from press_tools import MODELS, make_tools
from scipy.spatial.transform import Rotation
from slide_rig import make_slide_tools
from slide_scenes import TOP_M, fifty_pieces
from wrench_chain import push

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


@pytest.mark.parametrize(
    ("tilt", "share"), [(0.0, 1e-6), (2e-3, 0.01), (5e-3, 0.05), (1e-2, 0.2)]
)
def test_an_edge_on_a_face_in_pieces_is_pushed_as_by_the_whole_face(tilt, share):
    """Pieces beside its lowest point once let go of it at a tilt of a thousandth."""
    whole = box([0.1, 0.05, TOP_M], [0.05, 0.025, TOP_M / 2])
    edge = make_slide_tools()["edge"]
    rng = np.random.default_rng(0)
    for _ in range(20):
        heading = Rotation.from_rotvec([0, 0, rng.uniform(0, 2 * np.pi)])
        turn = heading * Rotation.from_rotvec([0, tilt, 0])
        p = [*rng.uniform([0.03, 0.02], [0.07, 0.03]), TOP_M + GAP_M]
        q = np.concatenate([np.roll(turn.as_quat(), 1), p])
        F_cut, F_whole = (push_at(edge, solid, q) for solid in (fifty_pieces(), whole))
        force_N = np.linalg.norm(F_whole[3:])
        assert force_N > 1.0
        assert F_cut[3:] == pytest.approx(F_whole[3:], abs=1e-6 * force_N)
        # A share of the edge's half length; once all of it.
        assert F_cut[:3] == pytest.approx(F_whole[:3], abs=share * 6e-3 * force_N)


def push_at(tool, solid, q_WT):
    """Returns the torque and force (6,) of contact at the tool's origin."""
    contacts = _core.SceneTracker(tool, [solid], TOLERANCE_M).query(q_WT)
    clusters = _core.share_stiffness(contacts, TOLERANCE_M)
    return push(clusters, 2e4, p_WTo=q_WT[4:]).F_To_W
