"""What is noted is what the updates of the tick saw, and costs nothing unasked."""

from dataclasses import replace

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import read_output
from fake_device import ScriptedDevice, make_reading
from pydrake.systems.framework import EventStatus

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.device.backend import DeviceReading, Fault, GateState
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.loop.outputs import make_log_header
from drake_haptics.simulation.run import make_simulator
from drake_haptics.systems.output.tick_log_sink import TickLogSink
from drake_haptics.tick_log.tick_log import read_tick_log
from drake_haptics.tick_log.tick_recorder import TickRecorder

TICKS = 300
NAMES = "X_WH V_WH F_Ho_W_commanded F_Ho_W_rendered X_WT V_WT".split()


@pytest.fixture
def scene(tmp_path):
    # Down onto the plate and 5 mm into it.
    waypoints = [
        (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 4e-3),
        (0.2, 0.01, 0.0, TOOL_HALF_HEIGHT - 5e-3),
    ]
    return over_a_plate(tmp_path, waypoints)


def record(path, scene, device=None, on_tick=None):
    with TickRecorder(path, make_log_header(scene)) as recorder:
        haptic = BuildHapticDiagram(scene, device=device, recorder=recorder)
        simulator = make_simulator(haptic)
        simulator.Initialize()
        if on_tick is not None:
            on_tick(haptic, simulator.get_context())
            simulator.set_monitor(
                lambda root: (on_tick(haptic, root), EventStatus.Succeeded())[1]
            )
        simulator.AdvanceTo(TICKS * haptic.period_s)
    log = read_tick_log(path)
    assert (len(log.rows), log.gaps) == (TICKS, ())
    return log.rows


def test_with_the_simulated_arm_it_is_what_a_monitor_sees_before_the_tick(
    tmp_path, scene
):
    seen = []

    def look(haptic, root):
        loop = haptic.loop
        values = [
            haptic.diagram.GetOutputPort(name).Eval(root) for name in (*NAMES, "status")
        ]
        contacts = read_output(loop.contact_query, "contacts", root)
        nearest = min(contacts.distance, default=np.inf)
        seen.append([root.get_time(), *np.concatenate(values), len(contacts), nearest])

    rows = record(tmp_path / "log", scene, on_tick=look)
    seen = np.array(seen[:TICKS])
    noted = np.hstack(
        [rows["time_s"][:, None], *(rows[name] for name in NAMES)]
        + [rows[name][:, None] for name in ("status", "contacts", "distance_m")]
    )
    np.testing.assert_array_equal(noted, seen)
    # The scene has what is to be told apart: a free tool, then a pressed one.
    assert rows["contacts"][0] == 0
    assert rows["contacts"].max() > 0
    assert np.linalg.norm(rows["F_Ho_W_commanded"][-1]) > 0.5
    assert np.isnan(rows["device_time_s"]).all()
    assert not rows["gate"].any()


def test_what_is_asked_at_a_tick_is_shown_after_it(tmp_path, scene):
    scene.device.max_force_N = 0.6
    rows = record(tmp_path / "log", scene)
    asked, shown = rows["F_Ho_W_commanded"][:-1], rows["F_Ho_W_rendered"][1:]
    limited = rows["status"][1:] == 1
    assert 0 < limited.sum() < len(limited)
    np.testing.assert_array_equal(shown[~limited], asked[~limited])
    force = np.linalg.norm(shown[limited, 3:], axis=1)
    np.testing.assert_allclose(force, 0.6, rtol=1e-12)


def test_with_a_device_it_is_the_reading_of_the_same_tick(tmp_path, scene):
    site = find_device_site(scene)
    start = pose_to_vector(site.X_BH)

    def read(k):
        at = start.copy()
        at[6] -= 2e-5 * k
        return DeviceReading(
            sequence=(1 << 32) - 100 + k,  # it wraps
            time_s=5.0 + 1e-3 * k,
            X_BH=at,
            V_BH=np.array([0.0, 0.0, 0.0, 0.0, 0.0, -0.02]),
            F_Ho_B=np.zeros(6),
            buttons=k % 3,
            gate=GateState.FAULT if k % 50 == 0 else GateState.ACTIVE,
            fault=Fault.STALE if k % 50 == 0 else Fault.NONE,
        )

    device = ScriptedDevice(read)
    rows = record(tmp_path / "log", scene, device)
    reads = device.reads - TICKS + np.arange(1, TICKS + 1)
    np.testing.assert_array_equal(rows["device_time_s"], 5.0 + 1e-3 * reads)
    np.testing.assert_array_equal(
        rows["sequence"], ((1 << 32) - 100 + reads) % (1 << 32)
    )
    np.testing.assert_array_equal(rows["buttons"], reads % 3)
    np.testing.assert_array_equal(rows["gate"] == 2, reads % 50 == 0)
    np.testing.assert_array_equal(rows["fault"] == 1, reads % 50 == 0)
    drop = rows["X_WH"][0, 6] - rows["X_WH"][:, 6]
    np.testing.assert_allclose(drop, 2e-5 * np.arange(TICKS), atol=1e-12)
    # What is asked for follows from the reading of the very tick: the coupling's
    # spring between that handle and that tool.
    spring = scene.coupling.stiffness_N_per_m * (rows["X_WT"] - rows["X_WH"])[:, 4:]
    damper = scene.coupling.damping_Ns_per_m * (rows["V_WT"] - rows["V_WH"])[:, 3:]
    np.testing.assert_allclose(
        rows["F_Ho_W_commanded"][:, 3:], spring + damper, atol=1e-6
    )


def test_without_a_recorder_there_is_no_sink(scene):
    assert not BuildHapticDiagram(scene).diagram.HasSubsystemNamed("tick_log_sink")


def test_a_period_must_be_positive():
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        TickLogSink(None, 0.0)


def test_a_log_of_another_tick_is_refused(tmp_path, scene):
    header = replace(make_log_header(scene), period_s=2e-3)
    with TickRecorder(tmp_path / "run.tick", header) as recorder:
        with pytest.raises(
            ValueError, match=r"^recorder: its header has ticks of 0\.00"
        ):
            BuildHapticDiagram(scene, recorder=recorder)


def test_a_first_reading_is_not_noted_twice(tmp_path, scene):
    start = pose_to_vector(find_device_site(scene).X_BH)
    device = ScriptedDevice(
        lambda k: make_reading(k, position=start[4:], wxyz=start[:4])
    )
    rows = record(tmp_path / "log", scene, device)
    assert (np.diff(rows["sequence"]) == 1).all()
