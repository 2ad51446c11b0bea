"""Replay: the same scene computes the same bits; another one differs where it must."""

import dataclasses

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from fake_device import ScriptedDevice
from tick_log_samples import assert_same_bits, make_part

from drake_haptics import find_scene, load_scene
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.device.backend import DeviceReading
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.loop.outputs import make_log_header
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    PassivityParameters,
    ShadingParameters,
)
from drake_haptics.scene.settings import change_scene
from drake_haptics.simulation.replay_log import load_log_scene, replay
from drake_haptics.simulation.run import run
from drake_haptics.tick_log.log_diff import compare_logs
from drake_haptics.tick_log.log_format import (
    CLOCK_QUANTITIES,
    DEVICE_QUANTITIES,
    SLICES,
    TickLogError,
)
from drake_haptics.tick_log.tick_log import Gap, TickLog, read_tick_log
from drake_haptics.tick_log.tick_recorder import TickRecorder

# Down, 8 mm into the plate, and along it.
SCRAPE = [
    (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 5e-3),
    (0.1, 0.0, 0.0, TOOL_HALF_HEIGHT - 8e-3),
    (0.3, 0.03, 0.0, TOOL_HALF_HEIGHT - 8e-3),
    (0.5, 0.03, 0.02, TOOL_HALF_HEIGHT + 5e-3),
]


def record(path, scene, duration_s=0.5, device=None):
    with TickRecorder(path, make_log_header(scene)) as recorder:
        haptic = BuildHapticDiagram(scene, device=device, recorder=recorder)
        run(haptic, duration_s)
    return read_tick_log(path)


def assert_bit_equal(log, again):
    """Compares all but the clocks, with an eye of its own."""
    for rows in (log.rows, again.rows):
        for name in CLOCK_QUANTITIES:
            rows.reals[:, SLICES[name]] = 0.0
    assert_same_bits(log.rows, again.rows)


def make_scene(folder, kind):
    scene = over_a_plate(folder, SCRAPE, tool="ball" if "ball" in kind else "cube")
    if "effects" in kind:
        scene.effects = Effects(
            shading=ShadingParameters(),
            friction=FrictionParameters(coefficient=0.6),
            braking=BrakingParameters(),
            gravity=GravityParameters(),
            passivity=PassivityParameters(),
        )
    if "octree" in kind:
        scene.contact.clustering = "octree"
        scene.contact.cluster_size_m = 5e-3
    if "limited" in kind:
        scene.device.max_force_N, scene.device.max_torque_Nm = 0.8, 0.01
    if "odd rate" in kind:
        scene.device.rate_hz = 700.0
    return scene


@pytest.mark.parametrize(
    "kind",
    ["cube", "ball", "cube, effects", "ball, effects, limited", "octree, odd rate"],
)
def test_the_same_scene_gives_the_same_bits(tmp_path, kind):
    log = record(tmp_path / "log", make_scene(tmp_path, kind))
    # There is something to compute.
    assert log.rows["contacts"].max() > 0
    assert np.linalg.norm(log.rows["F_Ho_W_commanded"][:, 3:], axis=1).max() > 0.7
    assert_bit_equal(log, replay(log))


def test_friction_sticks_and_slips_in_what_is_compared(tmp_path):
    # Else the test above would say nothing of friction.
    with_it = record(tmp_path / "a", make_scene(tmp_path, "cube, effects"))
    scene = make_scene(tmp_path, "cube, effects")
    scene.effects.friction = None
    without = replay(with_it, scene)
    diff = {q.name: q for q in compare_logs(with_it, without).quantities}
    assert diff["X_WH position"].differing == 0
    assert diff["F_Ho_W_commanded force"].largest > 0.5


def test_a_log_with_steps_between_its_ticks_is_replayed(tmp_path):
    """It lacks the handle between ticks, so that the tool is only nearly as it was."""
    scene = over_a_plate(tmp_path, SCRAPE)
    scene = change_scene(scene, ["contact.law=constraint", "device.servo_rate_hz=4000"])
    log = record(tmp_path / "log", scene, 0.2)
    assert log.rows["contacts"].max() > 0
    diff = {q.name: q for q in compare_logs(log, replay(log)).quantities}
    assert diff["X_WH position"].differing == 0
    assert diff["X_WT position"].largest < 2e-4


@pytest.mark.parametrize("name", ["cup_spoon", "torus_peg", "rubbed_sphere"])
def test_shipped_scenes_give_the_same_bits(tmp_path, name):
    log = record(tmp_path / "log", load_scene(find_scene(name)), 1.2)
    assert log.rows["contacts"].max() > 0
    assert_bit_equal(log, replay(log))


def test_a_run_with_a_real_device_gives_the_same_bits(tmp_path):
    scene = make_scene(tmp_path, "cube, effects")
    start = pose_to_vector(find_device_site(scene).X_BH)

    def read(k):
        X_BH = start.copy()
        # A hand that trembles as it presses, and a driver that is late at times.
        k -= k % 7 == 0
        X_BH[4:] += [1e-5 * k, 2e-4 * np.sin(k), -4e-5 * min(k, 400)]
        V_BH = np.array([0.1 * np.cos(k), 0.0, 0.0, 0.01, 0.2 * np.cos(k), -0.04])
        return DeviceReading(k, 1e-3 * k, X_BH, V_BH, np.zeros(6))

    log = record(tmp_path / "log", scene, device=ScriptedDevice(read))
    assert log.rows["contacts"].max() > 0
    again = replay(log)
    assert compare_logs(log, again).is_bit_equal
    for name in DEVICE_QUANTITIES:
        log.rows[name][:] = 0
    assert_bit_equal(log, again)


def test_other_gains_differ_from_the_first_contact_on(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"))
    scene = change_scene(load_log_scene(log), ["contact.stiffness_N_per_m=4000"])
    again = replay(log, scene)
    diff = compare_logs(log, again)
    assert not diff.same_scene
    by_name = {q.name: q for q in diff.quantities}
    for name in ("X_WH rotation", "X_WH position", "V_WH angular", "V_WH linear"):
        assert by_name[name].differing == 0
    first = int(np.argmax(log.rows["contacts"] > 0))
    # The contact first moves the tool, and the tool then the coupling.
    assert by_name["X_WT position"].first_tick == first + 1
    assert by_name["F_Ho_W_commanded force"].first_tick == first + 1
    # At rest in the press the softer contact yields five times as far: 4000, not 20000.
    press = slice(95, 100)
    depth = [x.rows["distance_m"][press].mean() for x in (log, again)]
    tolerance_m = scene.contact.tolerance_m
    assert (tolerance_m - depth[1]) / (tolerance_m - depth[0]) > 3.0


def test_a_scene_of_half_the_rate_sees_every_other_tick(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"))
    again = replay(log, change_scene(load_log_scene(log), ["device.rate_hz=500"]))
    assert again.header.period_s == 2e-3
    assert len(again.rows) == 250
    np.testing.assert_array_equal(again.rows["X_WH"], log.rows["X_WH"][::2])
    twice = replay(log, change_scene(load_log_scene(log), ["device.rate_hz=2000"]))
    np.testing.assert_array_equal(twice.rows["X_WH"][::2], log.rows["X_WH"])
    np.testing.assert_array_equal(twice.rows["X_WH"][1::2], log.rows["X_WH"])


def test_a_log_is_replayed_up_to_its_first_gap(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube, effects"))
    rest = make_part(log.rows, 320, 500)
    start = make_part(log.rows, 0, 300)
    rows = type(rest)(
        *(
            np.concatenate(pair)
            for pair in zip(vars(start).values(), vars(rest).values(), strict=True)
        )
    )
    again = replay(TickLog(log.header, rows, (Gap(300, 20),), 1))
    assert len(again.rows) == 300
    assert_bit_equal(dataclasses.replace(log, rows=start), again)


def test_a_log_without_its_start_is_refused(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"), 0.05)
    late = TickLog(log.header, make_part(log.rows, 10, 50), (Gap(0, 10),), 1)
    with pytest.raises(TickLogError, match="no first tick"):
        replay(late)


def test_the_log_of_the_replay_is_kept_where_asked(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"), 0.05)
    shares = []
    again = replay(
        log, out=tmp_path / "again", progress=lambda what, share: shares.append(share)
    )
    assert_same_bits(read_tick_log(tmp_path / "again").rows, again.rows)
    assert again.header == log.header


def test_a_scene_of_another_program_is_told(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"), 0.05)
    for text in ("magnets: 3\n", "[", "{}", "tool: {mesh: a.obj}\n"):
        other = dataclasses.replace(log.header, scene=text, program_version="9.9")
        with pytest.raises(
            TickLogError, match=r"(?s)drake_haptics 9\.9.*name a scene file"
        ):
            load_log_scene(dataclasses.replace(log, header=other))


def test_a_handle_that_was_lost_stops_the_replay(tmp_path):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"), 0.05)
    log.rows["X_WH"][20] = np.nan
    with pytest.raises(TickLogError, match=r"stopped at 0\.02.*not finite"):
        replay(log)


@pytest.mark.parametrize(
    "row", [np.zeros(7), 2.0 * np.eye(7)[0], 1e-200 * np.eye(7)[0]]
)
@pytest.mark.parametrize(("name", "tick"), [("X_WH", 20), ("X_WT", 0)])
def test_a_pose_without_a_unit_quaternion_is_told_with_its_tick(
    tmp_path, name, tick, row
):
    log = record(tmp_path / "log", make_scene(tmp_path, "cube"), 0.05)
    log.rows[name][tick] = row
    with pytest.raises(TickLogError, match=f"{name} of tick {tick} has no unit"):
        replay(log)
