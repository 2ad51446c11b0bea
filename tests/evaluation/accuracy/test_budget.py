"""A budget is held by the least that does, on a machine whose times are known."""

import math
from dataclasses import replace

import pytest
from accuracy_samples import make_row, make_study

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.accuracy.budget import (
    Trial,
    choose_setting,
    describe_file,
    describe_help,
    describe_outcome,
    describe_sacrifices,
    to_budget_data,
)
from drake_haptics.evaluation.accuracy.combinations import Combination
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

STUDY = make_study(
    make_row("the scene", "as it is", 100.0, 10.0, 0.0, is_scene=True),
    make_row(
        "contact.tolerance_m", "0.5 mm", 80.0, 8.0, 0.02, contact__tolerance_m=5e-4
    ),
    make_row(
        "tool.decomposition", "one hull", 60.0, 5.0, 0.3, tool__decomposition="hull"
    ),
    make_row("effects.shading", "no shading", 50.0, 9.0, 0.01, effects__shading=None),
)


@pytest.fixture(scope="module")
def scene():
    return load_scene(find_scene("rubbed_sphere"))


# Of all together: less than the sum.
TOGETHER = make_row("several", "all", 1.0, 1.0, 0.25)


def measure(settings):
    """The study of all settings, or that of one."""
    if settings is None:
        return STUDY
    (setting,) = settings
    return make_study(STUDY.rows[0], replace(TOGETHER, setting=setting))


class Machine:
    """Runs scenes in known times and notes them."""

    def __init__(self, tolerance_us=40.0, hull_us=80.0, shading_us=50.0, noise=()):
        self.runs = []
        self._savings = (tolerance_us, hull_us, shading_us)
        self._noise = list(noise)

    def __call__(self, scene):
        """The p99 of a scene, µs."""
        turned = (
            scene.contact.tolerance_m != 1e-3,
            scene.tool.decomposition == "hull",
            scene.effects.shading is None,
        )
        self.runs.append(turned)
        noise = self._noise.pop(0) if self._noise else 1.0
        pairs = zip(turned, self._savings, strict=True)
        return noise * (200.0 - sum(saving for on, saving in pairs if on))


def choose(scene, budget_us, machine, **settings):
    return choose_setting(
        scene, budget_us, make_study=measure, measure_p99=machine, **settings
    )


def labels(choice):
    return [row.setting.label for row in choice.trial.combination.rows]


@pytest.mark.parametrize(
    ("budget_us", "given_up"),
    [
        (200.0, []),
        (199.0, ["0.5 mm"]),
        (160.0, ["0.5 mm"]),
        (159.0, ["0.5 mm", "one hull"]),
        (80.0, ["0.5 mm", "one hull"]),
        (79.0, ["0.5 mm", "one hull", "no shading"]),
        (30.0, ["0.5 mm", "one hull", "no shading"]),
    ],
)
def test_the_least_that_holds_is_given_up(scene, budget_us, given_up):
    machine = Machine()
    choice = choose(scene, budget_us, machine)
    assert choice.holds
    assert labels(choice) == given_up
    assert choice.trial.middle_us <= budget_us
    assert machine(choice.scene) == choice.trial.middle_us


def test_nothing_is_measured_where_the_scene_holds(scene):
    choice = choose_setting(
        scene,
        300.0,
        make_study=lambda _: pytest.fail("measured"),
        measure_p99=Machine(),
    )
    assert choice.is_scene and choice.holds and choice.scene is scene
    assert len(choice.trial.p99_us) == 5
    words = describe_outcome(choice, "a_scene")
    assert words.startswith("a_scene as it is holds 300 µs: p99 200 µs a tick")
    assert "5 fresh runs (worst 200)" in words
    assert describe_sacrifices(choice, scene) == []


def test_a_setting_that_saves_less_than_it_said_is_left_for_the_next(scene):
    choice = choose(scene, 160.0, Machine(tolerance_us=5.0))
    assert labels(choice) == ["0.5 mm", "one hull"]
    tried = [[r.setting.label for r in t.combination.rows] for t in choice.trials]
    assert tried == [[], ["0.5 mm"], ["0.5 mm", "one hull"]]


def test_a_setting_that_saves_more_than_it_said_spares_the_next(scene):
    # By the study it takes both.
    choice = choose(scene, 100.0, Machine(tolerance_us=110.0, hull_us=20.0))
    assert labels(choice) == ["0.5 mm"]


def test_runs_of_both_are_in_turns(scene):
    machine = Machine()
    choose(scene, 160.0, machine)
    as_it_is, turned = (False, False, False), (True, False, False)
    assert machine.runs == [as_it_is] * 5 + [turned, as_it_is] * 5


def test_progress_is_told_run_by_run(scene):
    told = []
    choose(scene, 160.0, Machine(), runs=2, progress=lambda *now: told.append(now))
    assert told == [
        ("the scene as it is: run 1 of 2", 0.0),
        ("the scene as it is: run 2 of 2", 0.5),
        ("combination 1 of 3: run 1 of 2", 0.0),
        ("combination 1 of 3: run 2 of 2", 0.5),
    ]


def test_a_scene_that_was_only_disturbed_gives_up_nothing(scene):
    # Its first runs are slow because of something else, its later ones are not.
    machine = Machine(30.0, 60.0, 50.0, noise=[1.2, 1.2] + [0.9] * 13)
    choice = choose(scene, 190.0, machine)
    assert choice.is_scene and choice.holds
    assert sorted(choice.trial.p99_us) == [180.0] * 8 + [240.0] * 2


def test_an_impossible_budget_is_told(scene):
    machine = Machine()
    choice = choose(scene, 29.0, machine)
    assert not choice.holds
    assert labels(choice) == ["0.5 mm", "one hull", "no shading"]
    words = describe_outcome(choice, "a_scene")
    assert words.startswith("Nothing that may be given up makes a_scene hold 29 µs")
    assert "has a p99 of 30.0 µs" in words
    assert any("somewhat above 30.0 µs" in line for line in describe_help(choice))


def test_what_cannot_be_run_holds_nothing(scene):
    def run(changed):
        if changed.tool.decomposition == "hull" and changed.effects.shading is not None:
            raise HapticsError("the hull is flat")
        return Machine()(changed)

    choice = choose(scene, 100.0, run)
    assert labels(choice) == ["0.5 mm", "one hull", "no shading"]
    assert math.isinf(choice.trials[1].middle_us)


@pytest.mark.parametrize(
    ("p99_us", "holds"),
    [
        ((100.0,), True),
        ((101.0,), False),
        ((90.0, 100.0, 110.0), True),
        ((90.0, 100.0, 111.0), False),
        ((90.0, 90.0, 90.0, 111.0, 300.0), False),
        ((90.0, 90.0, 90.0, 110.0, 300.0), True),
        ((90.0, 90.0, 101.0, 101.0, 101.0), False),
    ],
)
def test_a_budget_is_kept_within_ten_percent(p99_us, holds):
    assert Trial(Combination((), 1.0), p99_us, p99_us).holds(100.0) == holds


def test_what_is_given_up_is_said_from_what_to_what(scene):
    choice = choose(scene, 79.0, Machine())
    tolerance, hull, shading, together = describe_sacrifices(choice, scene)
    assert "contact.tolerance_m from 0.001 to 0.0005 (0.5 mm)" in tolerance
    assert "0.020 N rms, 0.080 N at most; a difference of model" in tolerance
    assert "tool.decomposition from surface to hull (one hull)" in hull
    assert hull.endswith("0.300 N rms, 1.200 N at most")
    assert "an EFFECT that the scene names" in shading
    assert 'effects.shading from {"crease_angle_deg": 30.0} to none' in shading
    assert together.endswith("0.250 N rms, 1.000 N at most")
    head, *lines = describe_file(choice, scene, "a_scene")
    assert head.startswith("a_scene holds 79 µs with what follows: p99 30.0 µs")
    assert len(lines) == 4


def test_the_figures_are_ready_for_json(scene):
    data = to_budget_data(choose(scene, 160.0, Machine()), scene)
    assert data["holds"] and data["p99_us"] == 160.0 and data["scene_p99_us"] == 200.0
    (lost,) = data["given_up"]
    assert lost["setting"]["changes"] == {"contact.tolerance_m": 5e-4}
    assert lost["force_rms_N"] == 0.02 and not lost["is_effect"]
    assert len(data["trials"]) == 2
    # Of one setting alone there is nothing to be put together.
    assert data["force_rms_N"] is None
    both = to_budget_data(choose(scene, 100.0, Machine()), scene)
    assert len(both["given_up"]) == 2 and both["force_rms_N"] == 0.25


@pytest.mark.parametrize("budget_us", [0.0, -1.0, math.nan, math.inf])
def test_a_budget_that_is_none(scene, budget_us):
    with pytest.raises(ValueError, match="budget_us must be positive and finite"):
        choose(scene, budget_us, Machine())


def test_no_run_is_no_measurement(scene):
    with pytest.raises(ValueError, match="runs must be at least 1, is 0"):
        choose(scene, 100.0, Machine(), runs=0)
