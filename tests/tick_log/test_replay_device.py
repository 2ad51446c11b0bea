"""A log as a device: in its base's frame, one tick per command."""

import dataclasses

import numpy as np
import pytest
from box_scenes import over_a_plate
from device_diagram import make_diagram
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.analysis import Simulator
from tick_log_samples import HEADER, make_rows, make_smooth_rows, write_log

from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.device.backend import GateState
from drake_haptics.loop.open_device import open_device
from drake_haptics.tick_log.log_format import TickLogError
from drake_haptics.tick_log.replay_device import ReplayDevice
from drake_haptics.tick_log.tick_log import Gap, TickLog

X_WB = RigidTransform(RollPitchYaw(0.3, -0.8, 2.0), [0.4, -0.2, 0.1])


def make_log(ticks=5, gaps=()):
    rows = make_smooth_rows(ticks)
    for k in range(ticks):
        pose = RigidTransform(RollPitchYaw(0.1 * k, 0.2, -0.3), [0.01 * k, 0.2, -0.1])
        rows["X_WH"][k] = pose_to_vector(pose)
    rows["buttons"][:] = np.arange(ticks)
    header = dataclasses.replace(HEADER, X_WB=pose_to_vector(X_WB).tolist())
    return TickLog(header, rows, gaps, 0)


def test_it_stands_until_it_is_enabled_and_moves_by_a_tick_per_command():
    device = ReplayDevice(make_log())
    seen = [device.read() for _ in range(3)]
    assert [r.sequence for r in seen] == [0, 0, 0]
    assert seen[0].gate == GateState.IDLE
    sequences = []
    for _ in range(7):
        device.write(None)
        sequences.append(device.read().sequence)
    assert sequences == [0, 1, 2, 3, 4, 4, 4]
    assert device.read().gate == GateState.ACTIVE
    assert device.read().buttons == 4
    assert device.get_link_status().received == 5
    device.close()
    device.close()
    assert device.read().gate == GateState.IDLE


def test_it_stands_still_after_its_last_tick():
    log = make_log()
    device = ReplayDevice(log)
    for _ in range(5):
        device.write(None)
    assert np.linalg.norm(device.read().V_BH) > 0
    last = device.read().X_BH
    for _ in range(2):
        device.write(None)
        assert not device.read().V_BH.any()
        np.testing.assert_array_equal(device.read().X_BH, last)


def test_a_closed_one_stays_where_it_is():
    device = ReplayDevice(make_log())
    device.write(None)
    device.close()
    for _ in range(2):
        device.write(None)
    reading = device.read()
    assert (reading.sequence, reading.gate) == (0, GateState.IDLE)


def test_it_tells_of_the_handle_in_its_base():
    log = make_log()
    with ReplayDevice(log) as device:
        device.write(None)
        for k in range(5):
            reading = device.read()
            X_WH = X_WB @ vector_to_pose(reading.X_BH)
            assert X_WH.IsNearlyEqualTo(vector_to_pose(log.rows["X_WH"][k]), 1e-14)
            R_WB = X_WB.rotation().matrix()
            V_WH = np.concatenate([R_WB @ reading.V_BH[:3], R_WB @ reading.V_BH[3:]])
            np.testing.assert_allclose(V_WH, log.rows["V_WH"][k], atol=1e-14)
            assert reading.time_s == log.rows["time_s"][k]
            assert not reading.F_Ho_B.any()
            device.write(None)


def test_a_loop_meets_each_tick_at_its_time():
    log = make_log(20)
    backend = ReplayDevice(log)
    diagram, device = make_diagram(backend, X_WB=X_WB, first=backend.read())
    simulator = Simulator(diagram)
    context = device.GetMyContextFromRoot(simulator.get_context())
    for k in range(20):
        # In the middle of the tick: after its updates.
        simulator.AdvanceTo((k + 0.5) * 1e-3)
        X_WH = device.GetOutputPort("X_WH").Eval(context)
        np.testing.assert_allclose(X_WH, log.rows["X_WH"][k], atol=1e-14)
        assert device.GetOutputPort("reading").Eval(context).sequence == k


def test_it_is_opened_by_its_address(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.03)])
    # A name in which a reader of addresses could find more than a file.
    path = write_log(tmp_path / "a?b#c.tick", [make_smooth_rows(9)], end=9)
    device = open_device(f"replay:{path}", scene)
    assert device.read().sequence == 0
    with pytest.raises(TickLogError, match="is not a tick log"):
        open_device(f"replay:{scene.tool.mesh}", scene)


def test_it_stops_at_a_gap():
    device = ReplayDevice(make_log(5, (Gap(3, 1),)))
    for _ in range(9):
        device.write(None)
    assert device.read().sequence == 2


def test_a_log_without_its_start_is_refused():
    log = TickLog(HEADER, make_rows(3, first=5), (Gap(0, 5),), 1)
    with pytest.raises(TickLogError, match="no first tick"):
        ReplayDevice(log)


@pytest.mark.parametrize("length", [0.0, 0.5, 2.0])
def test_a_pose_without_a_unit_quaternion_is_told_with_its_tick(length):
    log = make_log()
    log.rows["X_WH"][3, :4] *= length
    with pytest.raises(TickLogError, match="X_WH of tick 3 has no unit quaternion"):
        ReplayDevice(log)
