"""Combinations go from the scene to the fastest, by the price of each step."""

import math
from dataclasses import replace

import pytest
from accuracy_samples import make_row, make_study

from drake_haptics.evaluation.accuracy.combinations import list_combinations
from drake_haptics.evaluation.accuracy.figures import Row
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

# A row's p99 is twice its median: make_row's tick.
SCENE = make_row("the scene", "as it is", 100.0, 10.0, 0.0, is_scene=True)
FINE = make_row("tolerance", "0.5 mm", 90.0, 8.0, 0.1, contact__tolerance_m=5e-4)
COARSE = make_row("tolerance", "0 mm", 60.0, 5.0, 0.2, contact__tolerance_m=0.0)
HULL = make_row("tool", "one hull", 80.0, 4.0, 0.3, tool__decomposition="hull")
FREE = make_row(
    "objects", "one hull", 95.0, 4.0, 0.0, environment__decomposition="hull"
)
SMOOTH = make_row(
    "friction",
    "no friction",
    50.0,
    9.0,
    0.01,
    effects__friction=None,
    environment__material__friction_coefficient=None,
)


@pytest.fixture(scope="module")
def scene():
    return load_scene(find_scene("rubbed_sphere"))


def labels(chain):
    return [[row.setting.label for row in step.rows] for step in chain]


def test_the_cheapest_saving_is_taken_first_and_effects_last(scene):
    chain = list_combinations(
        make_study(SCENE, SMOOTH, HULL, FINE, COARSE, FREE), scene
    )
    # Per microsecond of p99: objects 0; tolerance 0 mm 0.2/80, 0.5 mm 0.1/20; tool
    # 0.3/40; then the effect, however cheap.
    assert labels(chain) == [
        [],
        ["one hull"],
        ["one hull", "0 mm"],
        ["one hull", "0 mm", "one hull"],
        ["one hull", "0 mm", "one hull", "no friction"],
    ]
    assert [step.p99_us for step in chain] == [200.0, 190.0, 110.0, 70.0, -30.0]


def test_a_knob_may_be_turned_further(scene):
    dear = make_row("tolerance", "0 mm", 60.0, 5.0, 2.0, contact__tolerance_m=0.0)
    chain = list_combinations(make_study(SCENE, HULL, FINE, dear), scene)
    assert labels(chain) == [
        [],
        ["0.5 mm"],
        ["0.5 mm", "one hull"],
        ["one hull", "0 mm"],
    ]
    both = chain[-1].setting
    assert both.changes == {"tool.decomposition": "hull", "contact.tolerance_m": 0.0}
    assert both.apply(scene).contact.tolerance_m == 0.0


UNSTABLE = make_row(
    "x", "a", 50.0, 1.0, 0.1, stiffness=799.0, tool__decomposition="hull"
)
STRONG = make_row("x", "b", 50.0, 1.0, 3.0, tool__decomposition="hull")  # 12 N at most
WILD = replace(HULL, errors=replace(HULL.errors, energy_created_J=math.inf))
NEVER = {
    "the coupling unstable": UNSTABLE,
    "force beyond the device's": STRONG,
    "divergence": WILD,
    "another rate": make_row("x", "c", 50.0, 1.0, 0.0, device__rate_hz=500.0),
    "limits": make_row("x", "d", 50.0, 1.0, 0.0, device__max_force_N=100.0),
    "passivity": make_row("x", "e", 50.0, 1.0, 0.0, effects__passivity=None),
    "further effects": make_row("x", "f", 50.0, 1.0, 0.0, effects__gravity={}),
    "no saving": make_row("x", "g", 99.0, 1.0, 0.0, tool__decomposition="hull"),
    "no scene": make_row("x", "h", 50.0, 1.0, 0.0, tool__decomposition="hull",
                         contact__cluster_size_m=1.0),
    "no figures": Row(Setting("x", "i", {}), False, None, None, failure_reason="none"),
}  # fmt: skip


@pytest.mark.parametrize("why", NEVER)
def test_what_is_never_taken(scene, why):
    assert labels(list_combinations(make_study(SCENE, NEVER[why]), scene)) == [[]]
    # The same row is taken where nothing is amiss with it.
    row = make_row("x", "z", 50.0, 1.0, 0.1, tool__decomposition="hull")
    assert labels(list_combinations(make_study(SCENE, row), scene)) == [[], ["z"]]


def test_two_knobs_do_not_undo_each_other(scene):
    one = make_row("x", "a", 80.0, 1.0, 0.1, contact__tolerance_m=0.0)
    other = make_row("y", "b", 50.0, 1.0, 0.3, contact__tolerance_m=1e-4)
    assert labels(list_combinations(make_study(SCENE, one, other), scene)) == [
        [],
        ["a"],
    ]


def test_the_scene_itself_must_be_measured(scene):
    with pytest.raises(ValueError, match="did not measure the scene itself"):
        list_combinations(make_study(HULL), scene)
