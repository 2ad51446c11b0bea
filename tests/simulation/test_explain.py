"""The parts of a tick: all of them, why they are there, and what they take."""

import time
from dataclasses import replace

import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import EVERY
from fake_clock import FakeClock
from loop_by_hand import add_loop_by_hand
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import Effects
from drake_haptics.simulation.profiling import CallbackTimer, explain_tick
from drake_haptics.simulation.run import run
from drake_haptics.systems.device.haptic_device import HapticDevice


class StillArm(LeafSystem):
    """A device's backend that rests where the tool touches the plate."""

    def __init__(self, height_m):
        super().__init__()
        self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self._X_WH = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m]
        always = {self.nothing_ticket()}
        self.DeclareVectorOutputPort("X_WH", 7, self._calc_pose, always)
        self.DeclareVectorOutputPort("V_WH", 6, self._calc_velocity, always)

    def _calc_pose(self, context, output):
        output.SetFromVector(self._X_WH)

    def _calc_velocity(self, context, output):
        output.SetZero()


def build_with_own_arm(haptic):
    """Returns the loop of a scene on a device that its user has written."""
    waypoint = haptic.scene.hand.path.waypoints[0]
    arm = StillArm(waypoint.position_m[2])
    arm.set_name("my_arm")
    builder = DiagramBuilder()
    loop = add_loop_by_hand(
        builder,
        haptic,
        device=HapticDevice(arm, period_s=1e-3, max_force_N=1.0, max_torque_Nm=0.1),
        X_WT=RigidTransform(waypoint.position_m),
    )
    return replace(haptic, diagram=builder.Build(), loop=loop)


# The core does the work of four systems, or five with shading, in one call, and that of
# coupling and hold, unless passivity control comes in between, in another.
ALWAYS = ["rendered_force_hold", "simulated_arm", "contact_chain"]
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
    assert parts[0].why.startswith("always: couples tool and handle, limits")
    for part in parts:
        assert "effects" not in part.why
        assert part.mean_us > 0.0, part.name


def test_each_effect_is_there_by_its_key_and_takes_time(tmp_path):
    parts, _ = explain(touching(tmp_path, Effects(**EVERY)))
    (chain,) = (part for part in parts if part.name == "contact_chain")
    assert chain.why.endswith("in one call, with effects.shading")
    expected = [*ALWAYS[:2], "virtual_coupling", ALWAYS[2], REST]
    assert [part.name for part in parts if part.name in expected] == expected
    added = [part for part in parts if part.name not in expected]
    assert {part.why: part.system for part in added} == {
        "effects.friction": "StickSlipFriction",
        "effects.braking": "PreContactBraking",
        "effects.gravity": "ToolGravity",
        "effects.passivity": "PassivityControl",
    }
    for part in parts:
        assert part.mean_us > 0.0, part.name


def test_a_device_of_the_users_own_is_a_part_that_is_said_to_be_theirs(tmp_path):
    with CallbackTimer() as timer:
        haptic = BuildHapticDiagram(touching(tmp_path, Effects()))
        theirs = build_with_own_arm(haptic)
    run(theirs, 0.05, on_tick=timer.end_tick)
    parts = {part.name: part for part in explain_tick(theirs, timer)}
    assert parts["my_arm"].why == "yours: it was added to the loop"
    assert parts["my_arm"].system == "StillArm"
    assert parts["rendered_force_hold"].why.endswith("limits what the device shows")
    assert sum(part.share for part in parts.values()) == pytest.approx(1.0)


def test_times_and_shares_add_to_the_tick(tmp_path, monkeypatch):
    # Times are then numbers of readings, whatever else the computer does.
    clock = FakeClock(reading_s=1e-6)
    monkeypatch.setattr(time, "perf_counter", clock)
    parts, figures = explain(touching(tmp_path, Effects(**EVERY)))
    assert sum(part.share for part in parts) == pytest.approx(1.0)
    tick_us = sum(part.mean_us for part in parts)
    for part in parts:
        assert part.share == pytest.approx(part.mean_us / tick_us)
    # The same ticks, measured by the run itself, which reads the clock once more.
    assert tick_us == pytest.approx(figures["tick_us"]["median"] - 1.0)


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
