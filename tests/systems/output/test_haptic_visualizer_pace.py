"""When the loop is drawn, and how little of a tick that takes."""

import numpy as np
import pytest
from fake_clock import FakeClock
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from visualizer_rig import FakeMeshcat, make_context, make_visualizer

from drake_haptics.systems.output import haptic_visualizer


def test_nothing_is_drawn_while_nobody_looks():
    meshcat = FakeMeshcat(connections=0)
    visualizer = make_visualizer(meshcat)
    visualizer.ForcedPublish(make_context(visualizer, [-0.001]))
    assert "/haptics/tool" not in meshcat.transforms


def test_drawing_takes_at_most_its_share_of_clock_time(monkeypatch):
    clock = FakeClock()
    monkeypatch.setattr(haptic_visualizer.time, "perf_counter", clock)
    meshcat = FakeMeshcat()
    drawn = []

    def slow_transform(path, X, time=None):
        if path == "/haptics/tool":
            drawn.append(clock.now_s)
            clock.now_s += 0.010  # a frame takes 10 ms

    visualizer = make_visualizer(meshcat)
    meshcat.SetTransform = slow_transform
    while clock.now_s < 7.0:
        X_WT = RigidTransform([clock.now_s, 0, 0])
        visualizer.ForcedPublish(make_context(visualizer, X_WT=X_WT))
        clock.now_s += 1 / 32
    assert 0.010 * len(drawn) <= 0.05 * 2.0 + 0.010
    assert len(drawn) >= 8


@pytest.mark.parametrize("recording", [False, True])
def test_what_rests_is_sent_once_and_recorded_in_every_frame(monkeypatch, recording):
    """A page draws whatever it is sent, which without a graphics card takes long."""
    clock = FakeClock()
    monkeypatch.setattr(haptic_visualizer.time, "perf_counter", clock)
    meshcat = FakeMeshcat()
    visualizer = make_visualizer(meshcat)
    if recording:
        visualizer.StartRecording()
    sent = []

    def call(path, *_):
        sent.append(path)

    meshcat.SetTransform = meshcat.SetProperty = call

    def draw(p_WT):
        clock.now_s += 1.0
        sent.clear()
        X_WT = RigidTransform(p_WT)
        context = make_context(visualizer, [-1e-3], f_H_W=(0, 0, 1), X_WT=X_WT)
        visualizer.ForcedPublish(context)
        return set(sent)

    first = draw([0, 0, 0.1])
    parts = {"tool", "handle", "grip", "coupling", "force/0", "contacts/0"}
    assert first > {f"/haptics/{part}" for part in parts}
    again = draw([0, 0, 0.1 + 1e-8])
    assert (again >= {f"/haptics/{part}" for part in parts}) == recording
    assert recording or again == set()
    # The tool and the line from the handle to it, which is longer, too.
    moves = {"/haptics/tool", "/haptics/coupling", "/haptics/coupling/line"}
    moved = draw([0, 0, 0.1001])
    assert moved >= moves and (recording or moved == moves)


def test_a_frame_is_drawn_in_slices_that_no_tick_notices(monkeypatch):
    clock = FakeClock()
    monkeypatch.setattr(haptic_visualizer.time, "perf_counter", clock)
    meshcat = FakeMeshcat()
    visualizer = make_visualizer(meshcat)
    calls = []

    def call(path, *args):
        calls.append((ticks[-1], path))
        clock.now_s += 20e-6  # what a call of Meshcat's takes

    meshcat.SetTransform = meshcat.SetProperty = call
    ticks = [0]
    simulator = Simulator(visualizer, make_context(visualizer, [-1e-3] * 20))
    simulator.Initialize()
    for tick in range(1, 97):
        ticks.append(tick)
        simulator.AdvanceTo(tick / 1024)
    # The first frame: 20 contacts and 16 clusters, each placed, scaled and shown.
    assert len(calls) > 100
    per_tick = np.bincount([tick for tick, _ in calls])
    assert per_tick.max() * 20e-6 <= 60e-6 + 4 * 20e-6
    assert np.count_nonzero(per_tick) > 15


@pytest.mark.parametrize("recording", [False, True])
def test_a_loop_that_sheds_load_draws_nothing_but_a_recording(recording):
    meshcat = FakeMeshcat()
    visualizer = make_visualizer(meshcat, enable_load_shedding=True)
    if recording:
        visualizer.StartRecording()
    context = make_context(visualizer, [-1e-3])
    load_shedding = visualizer.GetInputPort("load_shedding")
    load_shedding.FixValue(context, [0.02, 1.0, 0.0])
    simulator = Simulator(visualizer, context)
    simulator.Initialize()
    simulator.AdvanceTo(0.125)
    assert ("/haptics/tool" in meshcat.transforms) == recording
    load_shedding.FixValue(context, [0.0, 1.0, 0.0])
    simulator.AdvanceTo(0.25)
    assert "/haptics/tool" in meshcat.transforms


def test_a_recording_is_complete_though_nobody_looks():
    meshcat = FakeMeshcat(connections=0)
    visualizer = make_visualizer(meshcat)
    visualizer.StartRecording()
    context = make_context(visualizer, [-0.001])
    for frame in range(5):
        context.SetTime(frame / 32)
        visualizer.ForcedPublish(context)
    visualizer.StopRecording()
    times = [time for time, path, name, _ in meshcat.frames if path == "/haptics/tool"]
    assert times == [0, 1 / 32, 2 / 32, 3 / 32, 4 / 32]
    context.SetTime(1.0)
    visualizer.ForcedPublish(context)
    assert max(time for time, *_ in meshcat.frames) == 4 / 32


def test_the_first_recorded_frame_says_of_every_arrow_whether_it_is_seen():
    meshcat = FakeMeshcat()
    visualizer = make_visualizer(meshcat)
    visualizer.ForcedPublish(make_context(visualizer, [-0.001, 0.001]))
    visualizer.StartRecording()
    visualizer.ForcedPublish(make_context(visualizer, [-0.001]))
    first = {
        path: value for _, path, name, value in meshcat.frames if name == "visible"
    }
    arrows = {path for (path, name) in meshcat.properties if name == "visible"}
    assert set(first) == arrows
    assert [
        path for path, seen in sorted(first.items()) if "contacts" in path and seen
    ] == ["/haptics/contacts/0/arrow/1"]


@pytest.mark.parametrize("tick_s", [1e-3, 1 / 1024, 2.5e-4, 3e-3, 0.1])
def test_frames_fall_on_ticks_to_the_last_bit(tick_s):
    meshcat = FakeMeshcat()
    visualizer = make_visualizer(meshcat, tick_s=tick_s)
    visualizer.StartRecording()
    Simulator(visualizer, make_context(visualizer)).AdvanceTo(3.0)
    times = [time for time, path, *_ in meshcat.frames if path == "/haptics/tool"]
    assert len(times) >= 3.0 / max(1 / 15, tick_s)
    assert np.all(np.diff(times) > 0.9 * max(1 / 64, tick_s))
    for time in times:
        assert time == round(time / tick_s) * tick_s
