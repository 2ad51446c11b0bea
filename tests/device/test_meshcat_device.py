"""Sliders, a button and a gamepad move a handle; the page needs no browser for that."""

import numpy as np
import pytest
from fake_clock import FakeClock
from meshcat_page import MeshcatPage
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.device import meshcat_device
from drake_haptics.device.backend import DeviceCommand, DeviceError, GateState
from drake_haptics.device.meshcat_device import MeshcatDevice
from drake_haptics.visualization.meshcat import start_meshcat

# A base that stands across, and a handle that is not straight in it.
X_WB = RigidTransform(RollPitchYaw(0.3, -0.2, 1.8), [0.1, 0.2, -0.3])
X_BH = RigidTransform(RollPitchYaw(-0.4, 0.5, 0.1), [0.02, -0.05, 0.3])
RADIUS_M = 0.12
SLIDERS = ["x (mm)", "y (mm)", "z (mm)", "roll (deg)", "pitch (deg)", "yaw (deg)"]
HOME = "bring the handle home"


@pytest.fixture
def clock(monkeypatch):
    clock = FakeClock()
    monkeypatch.setattr(meshcat_device, "monotonic", clock)
    return clock


@pytest.fixture(scope="module")
def meshcat():
    return start_meshcat()


@pytest.fixture
def device(meshcat, clock):
    with MeshcatDevice(
        meshcat, X_WB=X_WB, X_BH=X_BH, workspace_radius_m=RADIUS_M
    ) as device:
        yield device


def run(device, clock, duration_s, period_s=0.005):
    """Reads for a while; returns the last reading."""
    for _ in range(round(duration_s / period_s)):
        clock.now_s += period_s
        reading = device.read()
    return reading


def offset(reading):
    """How far the handle is from where it started, along and about the world's axes."""
    X_WH = X_WB @ vector_to_pose(reading.X_BH)
    X_WStart = X_WB @ X_BH
    R = X_WH.rotation() @ X_WStart.rotation().inverse()
    return X_WH.translation() - X_WStart.translation(), R


def test_it_starts_at_rest_where_it_was_put(device):
    reading = device.read()
    assert vector_to_pose(reading.X_BH).IsNearlyEqualTo(X_BH, 1e-12)
    np.testing.assert_array_equal(reading.V_BH, np.zeros(6))
    np.testing.assert_array_equal(reading.F_Ho_B, np.zeros(6))
    assert reading.gate is GateState.IDLE
    assert device.read().sequence == reading.sequence + 1


def test_the_controls_are_in_the_page(meshcat, device):
    assert sorted(meshcat.GetSliderNames()) == sorted(SLIDERS)
    assert [meshcat.GetSliderValue(name) for name in SLIDERS] == [0.0] * 6
    assert meshcat.GetButtonNames()[0] == HOME


def test_sliders_give_the_pose_in_the_world(meshcat, device, clock):
    for name, value in zip(SLIDERS, [30, -50, 70, 20, -40, 100], strict=True):
        meshcat.SetSliderValue(name, value)
    p, R = offset(run(device, clock, 3.0))
    np.testing.assert_allclose(p, [0.03, -0.05, 0.07], atol=1e-9)
    expected = RotationMatrix(RollPitchYaw(np.deg2rad([20, -40, 100])))
    np.testing.assert_allclose(R.matrix(), expected.matrix(), atol=1e-9)


def test_a_slider_that_jumps_does_not_make_the_handle_jump(meshcat, device, clock):
    meshcat.SetSliderValue("x (mm)", 120)
    meshcat.SetSliderValue("yaw (deg)", 180)
    before, fastest = device.read(), np.zeros(2)
    for _ in range(1500):
        reading = run(device, clock, 0.001, period_s=0.001)
        assert np.linalg.norm(reading.X_BH[4:] - before.X_BH[4:]) <= 0.5e-3 + 1e-12
        speeds = [np.linalg.norm(reading.V_BH[part]) for part in ([0, 1, 2], [3, 4, 5])]
        fastest = np.maximum(fastest, speeds)
        before = reading
    assert fastest[0] == pytest.approx(5.9, abs=0.1)
    assert fastest[1] == pytest.approx(0.5, abs=0.001)


def test_the_button_brings_it_home(meshcat, device, clock):
    meshcat.SetSliderValue("z (mm)", 44)
    run(device, clock, 1.0)
    with MeshcatPage(meshcat) as page:
        page.click_button(HOME)
        p, _ = offset(run(device, clock, 2.0))
    np.testing.assert_allclose(p, 0, atol=1e-9)
    assert meshcat.GetSliderValue("z (mm)") == 0.0


def test_a_gamepad_moves_at_a_speed_and_the_sliders_follow(meshcat, device, clock):
    with MeshcatPage(meshcat) as page:
        # Half a radius per second, to the left.
        page.send_gamepad([-0.56, 0.0, 0.0, 0.0], [0.0] * 17)
        run(device, clock, 1.0)
        # Let go.
        page.send_gamepad([0.05, 0.0, -0.05, 0.0], [0.0] * 17)
        p, R = offset(run(device, clock, 1.0))
    np.testing.assert_allclose(p, [-RADIUS_M / 2, 0, 0], atol=0.003)
    np.testing.assert_allclose(R.matrix(), RotationMatrix().matrix(), atol=1e-9)
    assert meshcat.GetSliderValue("x (mm)") == pytest.approx(1e3 * p[0], abs=0.6)


def test_a_gamepad_turns_after_its_first_button_and_comes_home(meshcat, device, clock):
    with MeshcatPage(meshcat) as page:
        page.send_gamepad([0.0] * 4, [1.0, 0.0, 0.0])
        assert run(device, clock, 0.1).buttons == 0b1
        page.send_gamepad([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        reading = run(device, clock, 0.5)
        assert reading.buttons == 0b100
        # Beyond its end a slider stays there.
        _, R = offset(run(device, clock, 2.0))
        turn = RotationMatrix.MakeYRotation(np.pi / 2)
        np.testing.assert_allclose(R.matrix(), turn.matrix(), atol=1e-6)
        page.send_gamepad([0.0] * 4, [0.0, 1.0])
        p, R = offset(run(device, clock, 2.0))
    np.testing.assert_allclose(p, 0, atol=1e-9)
    np.testing.assert_allclose(R.matrix(), RotationMatrix().matrix(), atol=1e-9)


def test_a_stick_of_a_page_that_has_gone_moves_nothing(meshcat, device, clock):
    with MeshcatPage(meshcat) as page:
        page.send_gamepad([0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        run(device, clock, 0.3)
    p, _ = offset(run(device, clock, 1.0))
    reading = run(device, clock, 2.0)
    np.testing.assert_allclose(offset(reading)[0], p, atol=1e-6)
    assert reading.buttons == 0


def test_a_stall_does_not_count_as_a_push(meshcat, device, clock):
    with MeshcatPage(meshcat) as page:
        page.send_gamepad([1.0, 0.0, 0.0, 0.0], [])
        clock.now_s += 30.0
        device.read()
        page.send_gamepad([0.0] * 4, [])
        p, _ = offset(run(device, clock, 1.0))
    assert 0.0 < p[0] < 0.006


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300])
def test_nonsense_from_a_page_leaves_the_handle_in_reach(meshcat, device, clock, value):
    with MeshcatPage(meshcat) as page:
        page.send_slider("x (mm)", value)
        page.send_gamepad([1e300, -1e300, 0.0, 0.0], [1e300])
        reading = run(device, clock, 2.0)
    assert np.isfinite(reading.X_BH).all()
    assert np.linalg.norm(offset(reading)[0]) <= RADIUS_M + 1e-9


def test_force_and_torque_are_shown_as_numbers(meshcat, device, clock):
    reading = device.read()
    F_Ho_B = np.array([0.0, 0.03, 0.04, 1.0, 2.0, 2.0])
    clock.now_s += 1.0
    device.write(DeviceCommand(F_Ho_B, reading.X_BH, reading.V_BH))
    assert meshcat.GetButtonNames() == [HOME, "force 3.0 N, torque 0.05 N·m"]
    reading = device.read()
    np.testing.assert_array_equal(reading.F_Ho_B, F_Ho_B)
    assert reading.gate is GateState.ACTIVE
    # Not with every write.
    device.write(DeviceCommand(2 * F_Ho_B, reading.X_BH, reading.V_BH))
    assert meshcat.GetButtonNames() == [HOME, "force 3.0 N, torque 0.05 N·m"]
    np.testing.assert_array_equal(device.read().F_Ho_B, 2 * F_Ho_B)


def test_a_wrench_that_is_none_is_shown_as_zero(device):
    reading = device.read()
    F_Ho_B = np.array([0.0, 0, 0, np.nan, 1, 1])
    device.write(DeviceCommand(F_Ho_B, reading.X_BH, reading.V_BH))
    np.testing.assert_array_equal(device.read().F_Ho_B, np.zeros(6))


def test_close_takes_the_controls_away_and_the_force(meshcat, device, clock):
    meshcat.SetSliderValue("x (mm)", 50)
    X = run(device, clock, 1.0).X_BH
    device.write(DeviceCommand(np.ones(6), X, np.zeros(6)))
    device.close()
    device.close()
    assert meshcat.GetSliderNames() == [] and meshcat.GetButtonNames() == []
    device.write(DeviceCommand(np.ones(6), X, np.zeros(6)))
    reading = run(device, clock, 1.0)
    np.testing.assert_allclose(reading.X_BH, X, atol=1e-6)
    np.testing.assert_array_equal(reading.F_Ho_B, np.zeros(6))
    assert reading.gate is GateState.IDLE


@pytest.mark.parametrize(
    "delete",
    [
        lambda meshcat: meshcat.DeleteSlider("yaw (deg)"),
        lambda meshcat: meshcat.DeleteButton(HOME),
        lambda meshcat: meshcat.DeleteAddedControls(),
    ],
    ids=["slider", "button", "all"],
)
def test_a_handle_whose_controls_are_deleted_stays_where_it_is(
    meshcat, device, clock, caplog, delete
):
    meshcat.SetSliderValue("x (mm)", 50)
    X = run(device, clock, 1.0).X_BH
    device.write(DeviceCommand(np.ones(6), X, np.zeros(6)))
    delete(meshcat)
    reading = run(device, clock, 1.0)
    device.write(DeviceCommand(np.ones(6), X, np.zeros(6)))
    np.testing.assert_allclose(reading.X_BH, X, atol=1e-6)
    np.testing.assert_array_equal(reading.F_Ho_B, np.zeros(6))
    assert meshcat.GetSliderNames() == [] and meshcat.GetButtonNames() == []
    [record] = caplog.records
    assert "open another MeshcatDevice" in record.getMessage()


def test_controls_of_the_same_names_are_left_alone(meshcat, clock):
    meshcat.AddSlider("yaw (deg)", -1.0, 1.0, 0.1, 0.5)
    with pytest.raises(DeviceError, match=r"already has controls named yaw \(deg\)"):
        MeshcatDevice(meshcat, X_WB=X_WB, X_BH=X_BH, workspace_radius_m=0.1)
    assert meshcat.GetSliderNames() == ["yaw (deg)"]
    assert meshcat.GetSliderValue("yaw (deg)") == 0.5
    meshcat.DeleteSlider("yaw (deg)")


@pytest.mark.parametrize("radius", [0.0, -1.0, np.nan, np.inf])
def test_a_radius_out_of_range_is_refused(meshcat, radius):
    with pytest.raises(ValueError, match="workspace_radius_m"):
        MeshcatDevice(meshcat, X_WB=X_WB, X_BH=X_BH, workspace_radius_m=radius)
