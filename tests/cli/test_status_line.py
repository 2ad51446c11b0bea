"""What the terminal shows during a run."""

import copy
import io
import itertools
import re
import time
from dataclasses import replace

import pytest
from fake_device import ScriptedDevice, make_reading
from rich.console import Console

from drake_haptics.cli.status_line import StatusLine, make_summary
from drake_haptics.cockpit.handle_holder import SoftStartDevice
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import Fault, GateState
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.simulation.run import run
from drake_haptics.simulation.statistics import RunStatistics


@pytest.fixture(scope="module")
def haptic():
    return BuildHapticDiagram(load_scene(find_scene("sphere_pen")))


def run_with_status(haptic, *, terminal):
    """Runs into contact, a tenth of a second of clock time per tick."""
    text = io.StringIO()
    console = Console(file=text, force_terminal=terminal, width=320, color_system=None)
    clock = itertools.count(0.0, 0.1)
    with StatusLine(console, haptic, clock=lambda: next(clock)) as status:
        figures = run(haptic, 1.5, energy=True, on_tick=status.end_tick).to_dict()
    return text.getvalue(), figures


def test_a_terminal_sees_time_contacts_and_force(haptic):
    text, _ = run_with_status(haptic, terminal=True)
    assert "1 contact, 1 cluster" in text
    assert "x real time" in text
    assert " N " in text and "mm deep" in text
    assert "-0.00" not in text


def follow_device(
    script, duration_s=0.05, width=200, wrap=lambda device: device, tool_mass_kg=None
):
    """Returns what a terminal sees of a run on a device, 0.1 s of clock per tick."""
    scene = load_scene(find_scene("sphere_pen"))
    scene.tool.mass_kg = tool_mass_kg or scene.tool.mass_kg
    haptic = BuildHapticDiagram(scene, device=wrap(ScriptedDevice(script)))
    text = io.StringIO()
    console = Console(file=text, force_terminal=True, width=width, color_system=None)
    clock = itertools.count(0.0, 0.1)
    pace = RealTimePacer(haptic.period_s)
    with StatusLine(console, haptic, pace, clock=lambda: next(clock)) as status:
        run(haptic, duration_s, pace=pace, on_tick=status.end_tick)
    return text.getvalue()


@pytest.mark.parametrize("gate", GateState)
def test_a_force_that_the_device_does_not_show_is_said_to_be_none(gate):
    text = follow_device(lambda call: replace(make_reading(call), gate=gate))
    assert f"{gate.name}" in text
    assert ("(not shown)" in text) == (gate != GateState.ACTIVE)
    assert "silent" not in text


def test_a_device_that_is_taken_says_what_it_waits_for():
    def take(device):
        return SoftStartDevice(
            device, max_force_N=8.5, max_torque_Nm=0.2, period_s=1e-3
        )

    def script(call):
        return replace(make_reading(call), gate=GateState.ACTIVE)

    # Force sets in after 0.1 s in which it was gentle.
    text = follow_device(script, duration_s=0.05, wrap=take)
    assert "WAITING: lead the handle" in text and "(not shown)" in text
    assert "ACTIVE" not in text and "IDLE" not in text
    assert "ACTIVE" in follow_device(script, duration_s=0.3, wrap=take)


def test_eighty_columns_show_the_touch_and_leave_out_how_late_ticks_are():
    def script(call):
        return replace(make_reading(call), gate=GateState.ACTIVE)

    text = follow_device(script, width=80)
    lines = re.findall(r"\d+\.\d s ·[^\r\n\x1b]*", text)
    assert lines and all(len(line) <= 80 for line in lines)
    for line in lines:
        assert line.endswith(" contacts, 0 clusters") and "mm deep" in line
        assert "ACTIVE" in line and "late" not in line
    assert "late p50" in follow_device(script, width=200)


def test_a_driver_that_has_gone_is_not_said_to_wait_for_enter():
    fault = replace(make_reading(7), gate=GateState.FAULT, fault=Fault.STALE)
    text = follow_device(
        lambda call: make_reading(call) if call < 9 else fault, duration_s=0.3
    )
    assert "ACTIVE" in text
    assert "FAULT (stale): silent for 1 s, is its driver running?" in text
    assert "Enter" not in text[text.index("silent") :]


def test_the_force_of_the_line_is_within_the_limits_of_the_device():
    # At first the tool is where the handle is, then 40 mm behind it, at 800 N/m: for
    # long, since it is heavy, so that every later line has the largest force.
    text = follow_device(
        lambda call: make_reading(call, position=(0, 0, 0.04 if call > 5 else 0)),
        tool_mass_kg=1e6,
    )
    forces = [float(force) for force in re.findall(r"([\d.]+) N ", text)]
    assert max(forces) == 8.5


def test_what_a_slow_loop_leaves_out_is_said():
    scene = load_scene(find_scene("sphere_pen"))
    scene.device.tick_budget_us = 1e-3
    words = "leaves out drawing, far near-contacts"
    haptic = BuildHapticDiagram(scene)
    text = io.StringIO()
    console = Console(file=text, force_terminal=True, width=200, color_system=None)
    clock = itertools.count(0.0, 0.1)
    with StatusLine(console, haptic, clock=lambda: next(clock)) as status:

        def end_tick(context):
            status.end_tick(context)
            # The line has a thread of its own, which a busy machine may keep waiting.
            deadline_s = time.monotonic() + 120.0
            while context.get_time() > 0.06 and words not in text.getvalue():
                assert time.monotonic() < deadline_s
                time.sleep(1e-3)
                status.end_tick(context)

        figures = run(haptic, 0.07, on_tick=end_tick).to_dict()
    assert "fine clusters" not in text.getvalue()
    console = Console(file=io.StringIO(), width=200)
    console.print(make_summary(figures))
    assert "far near-contacts in 20 ticks" in console.file.getvalue()


@pytest.fixture(scope="module")
def to_a_file(haptic):
    return run_with_status(haptic, terminal=False)


@pytest.fixture
def figures(to_a_file):
    """Figures of a run, for a test to change."""
    return copy.deepcopy(to_a_file[1])


def test_a_file_gets_no_status(to_a_file):
    assert to_a_file[0] == ""


def test_the_summary_has_the_figures(figures):
    text = io.StringIO()
    Console(file=text, width=320).print(make_summary(figures))
    assert f"force {figures['max_force_N']:.2f} N" in text.getvalue()
    assert "1,500 ticks" in text.getvalue()


def test_a_force_without_penetration_is_explained(figures):
    for distance_m, is_explained in [(-1e-4, False), (4.2e-4, True), (None, False)]:
        text = io.StringIO()
        figures["least_distance_m"] = distance_m
        Console(file=text, width=320).print(make_summary(figures))
        assert ("contact.tolerance_m" in text.getvalue()) == is_explained
        assert ("came within 0.420 mm" in text.getvalue()) == is_explained


def test_ticks_longer_than_their_period_are_told_of_with_what_helps(figures):
    for ticks, p99_us, most, is_slow, is_many in [
        (1500, 999.0, 500, False, False),
        (1500, 1001.0, 4, True, False),
        (1500, 1001.0, 500, True, True),
        (100, 1001.0, 500, False, False),
    ]:
        text = io.StringIO()
        figures["ticks"], figures["duration_s"] = ticks, 1e-3 * ticks
        figures["tick_us"]["p99"] = p99_us
        figures["contacts"]["max"] = most
        Console(file=text, width=320).print(make_summary(figures))
        assert ("too slow for ticks of 1000 µs" in text.getvalue()) == is_slow
        assert ("max_triangles" in text.getvalue()) == is_many


def energy_line(figures, **changes):
    """The summary of a run in which a part has other books."""
    for name, books in changes.items():
        figures["energy_J"][name] |= books
    text = io.StringIO()
    Console(file=text, width=320).print(make_summary(figures))
    lines = map(str.rstrip, text.getvalue().splitlines())
    return next(line for line in lines if line.startswith("energy"))


def test_the_summary_says_where_the_energy_went(figures):
    none = {name: {"beyond": 1e-12} for name in ("coupling", "contact", "tool")}
    line = energy_line(figures, device={"in": 0.0123, "out": 0.0045}, **none)
    assert "hand put in 12.3 mJ, got back 4.5 mJ" in line
    assert line.endswith("; good: no part made energy beyond what sampling explains")


def test_the_summary_names_what_makes_energy(figures):
    parts = {"contact": {"beyond": 2.5e-4}, "coupling": {"beyond": 1e-3}}
    line = energy_line(
        figures, device={"in": 0.01, "beyond": 0.0}, tool={"beyond": 0.0}, **parts
    )
    assert line.endswith(
        "made beyond what sampling explains: coupling 1 mJ, contact 0.25 mJ, at most"
        " 10 % of what the hand put in; good: the loop as a whole made none"
    )


def test_the_summary_tells_what_energy_the_hand_may_feel(figures):
    device = {"in": 0.01, "beyond": 5e-4}
    line = energy_line(figures, device=device, coupling={"beyond": 1e-3})
    assert "the loop as a whole made 0.5 mJ, 5 % of what the hand put in" in line
    assert "good" not in line and "lower contact or coupling gains" in line
    line = energy_line(figures, device=device | {"in": 0.0})
    assert "and the hand put in none" in line and "good" not in line


def test_a_run_that_booked_nothing_has_no_line_of_energy():
    text = io.StringIO()
    figures = RunStatistics(1e-3).to_dict()
    Console(file=text, width=320).print(make_summary(figures))
    assert "energy" not in text.getvalue()
