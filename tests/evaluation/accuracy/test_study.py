"""A whole study: complete, resumed, and never ended by a setting that cannot be."""

from concurrent.futures import ThreadPoolExecutor
from itertools import count

import pytest
from box_scenes import over_a_plate

from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.accuracy import study as study_module
from drake_haptics.evaluation.accuracy.knobs import AS_IT_IS
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.study import run_accuracy_study
from drake_haptics.evaluation.measuring import valgrind
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

OWN = Setting("device.rate_hz", "1000 Hz", {"device.rate_hz": 1000.0})
SLOW = Setting("device.rate_hz", "500 Hz", {"device.rate_hz": 500.0})
OCTREE = Setting(
    "contact.clustering",
    "octree of 5 mm",
    {"contact.clustering": "octree", "contact.cluster_size_m": 5e-3},
)
IMPOSSIBLE = Setting("tool.decomposition", "cubes", {"tool.decomposition": "cubes"})
SETTINGS = [SLOW, OWN, OCTREE, IMPOSSIBLE]


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A cube that is pressed on a plate and slides."""
    folder = tmp_path_factory.mktemp("scene")
    path = [(0.0, 0.0, 0.0, 0.015), (0.15, 0.0, 0.0, 0.006), (0.3, 0.01, 0.0, 0.006)]
    return over_a_plate(folder, path)


def _study(scene, **how):
    how = {"executor": SerialExecutor(), "quick": True} | how
    return run_accuracy_study(scene, "plate", settings=SETTINGS, **how)


@pytest.fixture(scope="module")
def told():
    """What the study tells while it is made, and how far it is."""
    return []


@pytest.fixture(scope="module")
def study(scene, told):
    """Made by a clock that moves by 40 s for each task."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study_module, "monotonic", count(0.0, 40.0).__next__)
        return _study(scene, progress=lambda *words: told.append(words))


def _errors(study):
    return [
        (row.setting, row.errors, row.pieces, row.failure_reason) for row in study.rows
    ]


def test_has_the_scene_first_and_a_row_for_each_setting(study):
    assert [row.setting for row in study.rows] == [AS_IT_IS, *SETTINGS]
    assert [row.is_scene for row in study.rows] == [True, False, True, False, False]
    assert study.ticks == 300 and 0 < study.contact_ticks < 300


def test_the_scene_is_measured_once(study):
    first, _, own, *_ = study.rows
    assert (own.cost, own.errors, own.pieces) == (
        first.cost,
        first.errors,
        first.pieces,
    )
    assert first.pieces == (1, 1)


def test_exact_pieces_of_convex_bodies_have_no_error(study):
    errors = study.rows[0].errors
    assert errors.force_max_N == errors.torque_max_Nm == errors.normal_jump_deg == 0.0
    assert errors.depth_max_m < 1e-12
    assert study.rows[1].errors.force_max_N > 0.01


def test_costs_are_those_of_ticks(study):
    for row in study.rows[:-1]:
        for times in (row.cost.tick, row.cost.native):
            assert 0.0 < times.p99_us <= times.p99_9_us
            assert times.median_us <= times.p99_us
        assert row.cost.instructions is None


def test_a_setting_that_cannot_be_says_why(study):
    row = study.rows[-1]
    assert row.cost is None and row.errors is None
    assert "tool.decomposition is 'cubes'" in row.failure_reason


@pytest.mark.parametrize(
    ("stage", "executor"),
    [("errors: 2 of", SerialExecutor()), ("times: 3 of", ThreadPoolExecutor(2))],
    ids=lambda value: type(value).__name__,
)
def test_goes_on_after_ctrl_c_whatever_the_executor(
    scene, study, tmp_path, stage, executor
):
    """Errors are the same; at the second stage all are those of the threads."""
    store = tmp_path / "store"

    def interrupt(what, share):
        if what.startswith(stage):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        _study(scene, store=store, progress=interrupt, executor=executor)
    told = []
    again = _study(scene, store=store, progress=lambda what, share: told.append(what))
    assert _errors(again) == _errors(study)
    # What was done is not done again.
    assert next(what for what in told if what.startswith(stage[:5])).startswith(stage)
    # Nor are times taken a second time.
    once_more = _study(scene, store=store)
    assert once_more == again


def test_tells_how_far_it_is(study, told):
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    assert shares[0] == 0.0 and shares[-1] == 1.0
    assert told[0][0] == "recording the motion"
    assert told[-1][0].startswith("times: ")


def test_tells_how_long_the_rest_of_a_stage_will_take(study, told):
    assert [what for what, _ in told if what.startswith("errors")] == [
        "errors: 0 of 4",
        "errors: 1 of 4, about 2 min left",
        "errors: 2 of 4, about 80 s left",
        "errors: 3 of 4, about 40 s left",
        "errors: 4 of 4",
    ]


def test_without_valgrind_it_says_so_at_once(scene, monkeypatch):
    monkeypatch.setattr(valgrind.shutil, "which", lambda name: None)
    with pytest.raises(HapticsError, match="not installed"):
        _study(scene, count_instructions=True)


def test_a_scene_by_the_other_law_is_refused_before_anything_is_measured():
    scene = load_scene(find_scene("peg_in_hole"))
    with pytest.raises(HapticsError, match=r"contact\.law is 'constraint'.*penalty"):
        run_accuracy_study(scene, "peg_in_hole", progress=pytest.fail)
