"""The rig that finds where a wrench jumps, and what it must not find."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from contact_samples import box, hull, pose
from continuity_rig import CAUSES, JUMP, Steps, compare, measure
from continuity_scenes import SCENES, make_scene
from continuity_table import PAGE, SHOWN, TITLES, make_steps, row
from continuity_walk import calc_rotation, calc_turn, walk
from press_rig import LARGEST_FORCE_N
from scipy.spatial.transform import Rotation
from wrench_chain import METHODS

from drake_haptics import _core

T = 1e-3
FLOOR = box([0.1, 0.1, 0.02], [0, 0, -0.01])
# A walk of two episodes.
STEPS = 4000


@cache
def measure_episodes(key: str) -> dict[str, Steps]:
    """The steps of a walk of two episodes through each method, for several tests."""
    return measure(make_scene(key), STEPS)


@pytest.mark.parametrize("rotvec", [[0, 0, 0], [1e-4, -2e-4, 3e-4], [0.3, 1.2, -0.4]])
def test_a_turn_is_that_of_its_rotation_vector(rotvec: list[float]) -> None:
    R = calc_rotation(np.array(rotvec, float))
    np.testing.assert_allclose(R, Rotation.from_rotvec(rotvec).as_matrix(), atol=1e-15)
    if np.linalg.norm(rotvec) < 1e-3:
        np.testing.assert_allclose(calc_turn(R), rotvec, atol=1e-10)


@pytest.mark.parametrize("key", ["flush-sinking", "prism-sinking", "spoon-cup-soft"])
def test_a_walk_stays_in_contact_within_the_press_range(key: str) -> None:
    scene = make_scene(key)
    ticks = list(walk(scene, 3000))
    compression = [scene.gains.tolerance_m - t.contacts.distance for t in ticks]
    deepest = np.array([c.max(initial=0.0) for c in compression])
    assert sum(t.begins for t in ticks) == 2
    assert (deepest > 0).mean() > 0.95
    # A few steps beyond the range, until it is steered back.
    range_m = LARGEST_FORCE_N / scene.gains.stiffness_N_per_m
    assert deepest.max() < range_m + 5e-4


def test_changes_of_contacts_are_told_apart() -> None:
    tip = hull(np.array([[0, 0, 0], [1, 0, 9], [-1, 1, 9], [-1, -1, 9]]) * 1e-3)

    def at(z: float, x: float = 0.0) -> _core.ContactSet:
        return _core.SceneTracker(tip, [FLOOR], T).query(pose([x, 0, z]))

    still = compare(at(0), at(0), T, 0.01)
    assert max(vars(still).values()) == 0
    assert compare(at(0), at(1e-6), T, 0.01).distance == pytest.approx(1e-6)
    assert compare(at(0), at(0, 2e-6), T, 0.01).point == pytest.approx(2e-7)
    gone = compare(at(-1e-4), at(2 * T), T, 0.01)
    assert gone.came == pytest.approx(T + 1e-4)
    assert gone.distance == 0
    slope = hull(Rotation.from_rotvec([0, 0.1, 0]).apply(FLOOR.vertices))
    sloping = _core.SceneTracker(tip, [slope], T).query(pose([0, 0, 0]))
    assert compare(at(0), sloping, T, 0.01).normal == pytest.approx(
        2 * np.sin(0.05) * T
    )


def test_the_octree_jumps_and_the_rig_knows_that_it_was_the_clusters() -> None:
    found = measure_episodes("peg-hole-sinking")["octree"]
    of_clusters = found.exceeds & (found.causes == CAUSES.index("clusters"))
    assert of_clusters.any()
    assert found.chain_gain[of_clusters].max() > 10 * JUMP


def test_a_box_that_rocks_is_steep_and_does_not_jump() -> None:
    found = measure_episodes("flush-sinking")["shared"]
    assert found.ratio.max() > JUMP
    assert (found.causes[found.exceeds] == CAUSES.index("steep")).all()
    assert found.ratio[:, 0].max() < 1 + 1e-6


@pytest.mark.parametrize(
    "key", ["box-sinking", "edge-sinking", "peg-hole-sinking", "legs-sinking"]
)
def test_shared_contacts_multiply_no_change(key: str) -> None:
    found = measure_episodes(key)["shared"]
    assert found.chain_gain.max() < 8


def test_contacts_that_only_glide_make_no_jump() -> None:
    found = measure_episodes("tips-sinking")
    assert found["octree"].ratio.max() > 3 * JUMP
    # Contacts along one direction are at most 4/3 as stiff as one; the tips press
    # along five, and shares shift.
    assert found["shared"].ratio[:, 0].max() < 5
    assert not found["shared"].exceeds.any()


def test_the_page_covers_every_scene_and_method() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert "| " + " | ".join(SHOWN) + " |" in page
    for key in SCENES:
        for method in METHODS:
            assert f"| {make_scene(key).name} | {method} | " in page


@pytest.mark.parametrize(
    "key", ["edge", "spoon-cup-soft", "tips-sinking", "flush-sinking"]
)
def test_the_first_steps_walked_again_change_no_more_than_the_page_tells(
    key: str,
) -> None:
    """Both walks begin alike: what the short one meets is in the page's row."""
    lines = [x.strip("| ").split(" | ") for x in PAGE.read_text("utf-8").splitlines()]
    for method, found in measure_episodes(key).items():
        [told] = [x for x in lines if x[:2] == [make_scene(key).name, method]]
        by_title = dict(zip(SHOWN[6:], told[6:], strict=True))
        for largest, text in zip(found.ratio.max(axis=0), told[2:6:2], strict=True):
            # The page has three digits.
            assert 0.0 < largest < 1.01 * float(text), method
        assert found.exceeds.sum() <= int(by_title[f"over {JUMP:g}"]), method
        assert found.chain_gain.max() < 1.01 * float(by_title["chain alone"]), method


def test_a_row_has_a_text_for_each_title() -> None:
    found = measure(make_scene("spike"), 500, ("octree",))["octree"]
    texts = row("spike", "octree", found)
    assert len(texts) == len(TITLES)
    assert texts[6:-1] == ["0"] * (1 + len(CAUSES)) + ["–"]


def test_the_page_sums_up_the_causes_of_all_scenes() -> None:
    counts = [str(i) for i in range(len(CAUSES))]
    rows = [
        [name, method, *["1"] * 5, *counts, "–", "2"]
        for name in ("one", "other")
        for method in METHODS
    ]
    told = make_steps(rows)
    assert "| one | octree | 1 | 1 | 1 | 1 | 1 | – | 2 |" in told
    for i, cause in enumerate(CAUSES):
        assert f"| {cause} | {2 * i} | {2 * i} |" in told
