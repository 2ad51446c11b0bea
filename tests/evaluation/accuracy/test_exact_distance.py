"""The exact distance of all pairs, against an enumeration in integers."""

import numpy as np
from box_scenes import over_a_plate, write
from minkowski_truth import place, signed_distance
from trimesh.creation import box
from trimesh.util import concatenate

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.evaluation.accuracy.truth import calc_exact_distance
from drake_haptics.loop.builder import BuildHapticDiagram

_REST = [(0.0, 0.0, 0.0, 0.03), (1.0, 0.0, 0.0, 0.03)]


def _make_haptic(folder):
    """Returns a cube over two slabs with a gap between, moved and turned."""
    scene = over_a_plate(folder, _REST)
    slabs = [box([0.05, 0.1, 0.02]) for _ in range(2)]
    slabs[0].apply_translation([-0.03, 0.0, 0.0])
    slabs[1].apply_translation([0.03, 0.0, 0.004])
    item = scene.environment[0]
    item.mesh = write(folder, "slabs", concatenate(slabs))
    item.pose.position_m, item.pose.rpy_deg = [0.01, 0.02, -0.01], [10.0, -5.0, 30.0]
    scene.contact.tolerance_m = 5e-3
    return BuildHapticDiagram(scene)


def test_is_the_least_of_all_pairs(tmp_path):
    haptic = _make_haptic(tmp_path)
    rng = np.random.default_rng(5)
    X_WT = np.hstack(
        [rng.normal(size=(40, 4)), rng.uniform(-1, 1, (40, 3)) * [0.05, 0.05, 0.03]]
    )
    X_WT[:, :4] /= np.linalg.norm(X_WT[:, :4], axis=1)[:, np.newaxis]
    found = calc_exact_distance(haptic, X_WT)
    X_WO = haptic.scene.environment[0].pose.to_rigid_transform().GetAsMatrix4()
    pieces = haptic.environment[0].pieces
    assert len(pieces) == 2
    (cube,) = haptic.tool.pieces
    for X, distance in zip(X_WT, found, strict=True):
        a_W = place(cube.vertices, vector_to_pose(X).GetAsMatrix4())
        exact = min(signed_distance(a_W, place(B.vertices, X_WO)) for B in pieces)
        if exact < 5e-3:
            assert abs(distance - exact) < 1e-12
        else:
            assert np.isinf(distance)
    assert (found < 0).sum() > 5 and np.isinf(found).sum() > 5


def test_does_not_remember_the_way(tmp_path):
    haptic = _make_haptic(tmp_path)
    X_WT = np.zeros((30, 7))
    X_WT[:, 0] = 1.0
    X_WT[:, 6] = np.linspace(0.03, -0.03, 30)
    there = calc_exact_distance(haptic, X_WT)
    back = calc_exact_distance(haptic, X_WT[::-1])[::-1]
    np.testing.assert_allclose(there, back, atol=1e-15)
