"""The benchmark's scenes: their motion, and both libraries on the same pieces."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_samples import box, l_prism, real_mesh
from scipy.spatial.transform import Rotation

from drake_haptics import Mesh, SceneTracker, decompose
from drake_haptics.evaluation.benchmark.scene_runs import (
    NAME,
    CoalScene,
    DrakeHapticsScene,
    run_scene,
)
from drake_haptics.evaluation.benchmark.scenes import (
    SceneAnswers,
    SceneProblem,
    make_touches,
    scene_makers,
)


def pieces(V: np.ndarray, F: np.ndarray):
    return decompose(Mesh.from_arrays(V, F), cache=False)


@pytest.fixture(scope="module")
def problem() -> SceneProblem:
    """A small box that touches one of two large ones, each a single piece."""
    V, F = box(size=(0.02, 0.03, 0.04), at=(-0.01, -0.015, -0.02))
    tool = pieces(V, F)
    target = pieces(*box(size=(0.1, 0.1, 0.1), at=(-0.05, -0.05, -0.05)))
    X_WO = np.tile(np.eye(4), (2, 1, 1))
    X_WO[1, 0, 3] = 0.3
    return SceneProblem(
        "boxes", tool, [target, target], X_WO, make_touches(tool, target, 3, seed=1)
    )


def test_touches_start_apart_touch_lightly_and_stay_slow(problem) -> None:
    for X_WT in problem.motions:
        steps = np.linalg.norm(np.diff(X_WT[:, :3, 3], axis=0), axis=1)
        R = X_WT[:, :3, :3]
        turns = Rotation.from_matrix(np.swapaxes(R[:-1], 1, 2) @ R[1:]).magnitude()
        assert steps.max() * 1000 < 0.1 and turns.max() * 1000 < 1
        alone = SceneTracker(problem.tool, problem.objects[:1], 0.02)
        trajectory = alone.query_trajectory(X_WT)
        assert 0.004 < trajectory[0].distance.min() <= 0.010 + 1e-9
        assert 0 > trajectory.distance.min() > -0.01


def test_coal_finds_the_same_nearest_distance(problem) -> None:
    pytest.importorskip("coal")
    ours, theirs = DrakeHapticsScene(problem), CoalScene(problem)
    for X_WT in problem.motions:
        mine, its = ours.run(X_WT), theirs.run(X_WT)
        apart = its.nearest_m > 0
        assert apart.any() and not apart.all()
        np.testing.assert_allclose(
            mine.nearest_m[apart], its.nearest_m[apart], atol=1e-5
        )
        np.testing.assert_array_equal(mine.nearest_m > 0, apart)
        assert its.num_contacts.max() == mine.num_contacts.max() == 1


def test_coal_takes_flat_pieces(problem) -> None:
    pytest.importorskip("coal")
    sheet = pieces(
        np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]),
        np.array([[0, 1, 2], [0, 2, 3]]),
    )
    above = np.eye(4)
    above[2, 3] = 0.021
    flat = SceneProblem("sheet", problem.tool, [sheet], np.eye(4)[None], [above[None]])
    assert sheet.pieces[0].dimension == 2
    assert CoalScene(flat).run(above[None]).nearest_m == pytest.approx(0.001)


class Scripted:
    """Contacts and times as told."""

    def __init__(self, contacts: list[int], seconds: list[float]):
        self._answers = SceneAnswers(
            np.array(contacts), np.full(len(contacts), -1e-3), np.array(seconds)
        )

    def run(self, X_WT: np.ndarray) -> SceneAnswers:
        """Gives the same answers whatever the motion."""
        return self._answers


def test_near_ticks_are_those_in_which_all_find_a_contact(problem) -> None:
    queries = {
        NAME: Scripted([9, 0, 2, 4, 4], [9e-6, 1e-6, 2e-6, 3e-6, 4e-6]),
        "peer": Scripted([9, 5, 5, 0, 5], [9e-6, 10e-6, 20e-6, 30e-6, 40e-6]),
    }
    one = SceneProblem("x", problem.tool, problem.objects, problem.X_WO, [np.eye(4)])
    ours, peer = run_scene(one, queries, repeats=3)
    assert (ours.near.ticks, ours.all_ticks.ticks) == (2, 4)
    assert ours.near.median_us == pytest.approx(3)
    assert peer.near.median_us == pytest.approx(30)
    assert ours.all_ticks.median_us == pytest.approx(2.5)
    assert (ours.median_contacts, ours.max_contacts) == (3, 4)
    assert ours.deepest_m == pytest.approx(1e-3)
    assert (ours.tool_pieces, ours.object_pieces, ours.objects) == (1, 2, 2)
    assert ours.triangles == 36


def test_an_object_of_many_pieces_is_touched_too() -> None:
    V, F = l_prism()
    body = pieces(0.05 * V, F)
    tool = pieces(*box(size=(0.01, 0.01, 0.01)))
    for X_WT in make_touches(tool, body, 2, seed=3):
        found = SceneTracker(tool, [body], 0.002).query_trajectory(X_WT)
        assert found.distance.min() < 0


def test_the_peg_stays_in_its_hole_and_touches_the_wall() -> None:
    peg = scene_makers(1)["peg in hole"]()
    answers = DrakeHapticsScene(peg).run(peg.motions[0])
    assert answers.nearest_m[0] > 0
    assert -0.0005 < answers.nearest_m.min() < -0.0001


def test_real_meshes_take_the_place_of_shapes() -> None:
    folder = real_mesh("cup_500.obj").parent
    assert "spoon on armadillo" in scene_makers(1, folder)
    assert "spoon on armadillo" not in scene_makers(1)
    cup = scene_makers(1, folder)["spoon on cup"]()
    assert len(cup.objects[0].mesh.triangles) == 500
