"""The parts of a tick: all of them, why they are there, and what they take."""

import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import EVERY
from pydrake.geometry import Meshcat

from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.callback_timer import CallbackTimer
from drake_haptics.explain import explain_tick
from drake_haptics.scene import Effects
from drake_haptics.simulation import run

ALWAYS = [
    "display_force_hold",
    "simulated_arm",
    "virtual_coupling",
    "haptic_tool",
    "contact_query",
    "contact_clustering",
    "penalty_force",
]
REST = "Drake and the rest"


def touching(folder, effects):
    """Returns a scene whose tool goes along the plate, touching it."""
    height = TOOL_HALF_HEIGHT - 1e-3
    path = [(0.0, 0.0, 0.0, height), (1.0, 0.02, 0.0, height)]
    scene = over_a_plate(folder, path)
    scene.effects = effects
    return scene


def explain(scene, meshcat=None):
    with CallbackTimer() as timer:
        haptic = BuildHapticDiagram(scene, meshcat=meshcat)
    figures = run(haptic, 0.3, on_tick=timer.end_tick).to_dict()
    return explain_tick(haptic, timer), figures


def test_a_bare_scene_has_what_is_always_there(tmp_path):
    parts, _ = explain(touching(tmp_path, Effects()))
    assert [part.name for part in parts] == [*ALWAYS, REST]
    for part in parts:
        assert "effects" not in part.why


def test_each_effect_is_there_by_its_key_and_takes_time(tmp_path):
    parts, _ = explain(touching(tmp_path, Effects(**EVERY)))
    added = [part for part in parts if part.name not in [*ALWAYS, REST]]
    assert {part.why: part.system for part in added} == {
        "effects.shading": "ForceShading",
        "effects.friction": "StickSlipFriction",
        "effects.braking": "PreContactBraking",
        "effects.gravity": "ToolGravity",
        "effects.passivity": "PassivityControl",
    }
    for part in parts:
        assert part.mean_us > 0.0, part.name


def test_times_and_shares_add_to_the_tick(tmp_path):
    parts, figures = explain(touching(tmp_path, Effects(**EVERY)))
    assert sum(part.share for part in parts) == pytest.approx(1.0)
    tick_us = sum(part.mean_us for part in parts)
    for part in parts:
        assert part.share == pytest.approx(part.mean_us / tick_us)
    # The same ticks, measured by the run itself.
    assert 0.7 < tick_us / figures["tick_us"]["median"] < 1.4


def test_the_page_is_a_part_where_there_is_one(tmp_path):
    parts, _ = explain(touching(tmp_path, Effects()), Meshcat())
    assert [part.name for part in parts] == [*ALWAYS, "haptic_visualizer", REST]


def test_a_run_is_the_same_when_it_is_explained(tmp_path):
    scene = touching(tmp_path, Effects(**EVERY))
    _, explained = explain(scene)
    figures = run(BuildHapticDiagram(scene), 0.3).to_dict()
    for key in ("ticks", "contacts", "clusters", "max_force_N", "max_penetration_m"):
        assert figures[key] == explained[key]
    assert figures["contacts"]["median"] > 0
