"""What a page says moves the handle, and what it is told is what was written."""

import gc
import json
import select
import time
import weakref

import numpy as np
import pytest
import websocket
from fake_clock import FakeClock
from meshcat_page import MeshcatPage
from pydrake.math import RigidTransform, RollPitchYaw
from scipy.spatial.transform import Rotation

from drake_haptics.common.errors import HapticsError
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.device.backend import DeviceCommand, GateState
from drake_haptics.visualization.meshcat import start_meshcat
from drake_haptics.web import handle as page_handle
from drake_haptics.web import mouse_device
from drake_haptics.web.mouse_device import MouseDevice

X_WB = RigidTransform(RollPitchYaw(0.3, -0.2, 1.8), [0.1, 0.2, -0.3])
X_BH = RigidTransform(RollPitchYaw(-0.4, 0.5, 0.1), [0.02, -0.05, 0.3])
RADIUS_M = 0.12
BOUND_S = 120.0
# Four radii before the workspace, Meshcat's camera sees so much of the world.
HEIGHT_M = 2 * 4 * RADIUS_M * np.tan(np.deg2rad(37.5))


@pytest.fixture
def clock(monkeypatch):
    clock = FakeClock()
    for module in (mouse_device, page_handle):
        monkeypatch.setattr(module, "monotonic", clock)
    return clock


@pytest.fixture(scope="module")
def meshcat():
    return start_meshcat()


def make(meshcat, **changes):
    options = {"workspace_radius_m": RADIUS_M, "max_force_N": 8.5, "max_torque_Nm": 0.2}
    return MouseDevice(meshcat, X_WB=X_WB, X_BH=X_BH, **{**options, **changes})


@pytest.fixture
def device(meshcat, clock):
    with make(meshcat) as device:
        yield device


class Page:
    """A page of the device, without a browser, while the device's loop goes on."""

    def __init__(self, device, clock):
        self._device, self._clock = device, clock
        url = device.url.replace("http", "ws")
        self._socket = websocket.create_connection(url, timeout=BOUND_S)
        self.hear("hello", lambda hello: True)

    def __enter__(self):
        """Nothing more to open."""
        return self

    def __exit__(self, *_):
        """Goes away."""
        self._socket.close()

    def turn(self):
        """One turn of the loop."""
        self._clock.now_s += 0.02
        self._device.read()
        time.sleep(0.002)

    def say(self, message):
        """Says something, as JSON if it is no text, and waits until it was heard."""
        before = self._device.get_link_status()
        if isinstance(message, bytes):
            self._socket.send_binary(message)
        else:
            text = message if isinstance(message, str) else json.dumps(message)
            self._socket.send(text)
        end = time.monotonic() + BOUND_S
        while self._device.get_link_status() == before:
            assert time.monotonic() < end
            self.turn()

    def hear(self, name, wanted):
        """Returns the first message of a name that is as wanted."""
        end = time.monotonic() + BOUND_S
        while time.monotonic() < end:
            self.turn()
            while self._socket.sock in select.select([self._socket.sock], [], [], 0)[0]:
                [(told, body)] = json.loads(self._socket.recv()).items()
                if told == name and wanted(body):
                    return body
        raise TimeoutError(name)


def settle(device, clock):
    """Lets the handle arrive; returns how it is displaced and turned in the world."""
    device.read()
    clock.now_s += 5.0
    reading = device.read()
    X_WH, X_WStart = X_WB @ vector_to_pose(reading.X_BH), X_WB @ X_BH
    R = X_WH.rotation() @ X_WStart.rotation().inverse()
    turn = Rotation.from_matrix(R.matrix()).as_rotvec()
    return X_WH.translation() - X_WStart.translation(), turn


def test_it_needs_nobody_to_look_at_it(device, clock):
    reading = device.read()
    assert vector_to_pose(reading.X_BH).IsNearlyEqualTo(X_BH, 1e-12)
    np.testing.assert_array_equal(reading.V_BH, np.zeros(6))
    assert reading.gate is GateState.IDLE
    device.write(DeviceCommand(np.ones(6), reading.X_BH, reading.V_BH))
    reading = device.read()
    assert reading.gate is GateState.ACTIVE
    np.testing.assert_array_equal(reading.F_Ho_B, np.ones(6))


def test_the_pointer_moves_the_handle_as_seen_from_the_front(device, clock):
    with Page(device, clock) as page:
        page.say({"do": "move", "by": [0.05, 0.0, 0.0]})
        p, turn = settle(device, clock)
        np.testing.assert_allclose(p, [0.05 * HEIGHT_M, 0, 0], atol=1e-9)
        page.say({"do": "move", "by": [0.0, -0.04, 0.02]})
        p, turn = settle(device, clock)
    expected = HEIGHT_M * np.array([0.05, 0.02, -0.04])
    np.testing.assert_allclose(p, expected, atol=1e-9)
    np.testing.assert_allclose(turn, 0, atol=1e-9)


def test_the_pointer_turns_the_handle_where_it_is(device, clock):
    with Page(device, clock) as page:
        page.say({"do": "turn", "by": [0.25, 0.0, 0.0]})
        p, turn = settle(device, clock)
        # To the right, the near side: about the vertical.
        np.testing.assert_allclose(turn, [0, 0, np.pi / 4], atol=1e-9)
        np.testing.assert_allclose(p, 0, atol=1e-9)
        page.say({"do": "home"})
        page.say({"do": "turn", "by": [0.0, 0.0, 0.1]})
        np.testing.assert_allclose(
            settle(device, clock)[1], [0, 0.1 * np.pi, 0], atol=1e-9
        )


def test_the_pointer_goes_with_the_camera(meshcat, device, clock):
    # From the left, half as far away.
    p_WH = (X_WB @ X_BH).translation()
    R_WC = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    camera = np.eye(4)
    camera[:3, :3], camera[:3, 3] = R_WC, p_WH - [2 * RADIUS_M, 0, 0]
    with MeshcatPage(meshcat) as view, Page(device, clock) as page:
        view.send_camera(RigidTransform(camera))
        for _ in range(10):
            page.turn()
        page.say({"do": "move", "by": [0.1, 0.0, 0.02]})
        p, _ = settle(device, clock)
    np.testing.assert_allclose(p, HEIGHT_M / 2 * np.array([0.02, -0.1, 0]), atol=1e-9)


@pytest.mark.parametrize("position", [np.nan, np.inf, 1e300])
def test_a_camera_out_of_this_world_changes_nothing(meshcat, device, clock, position):
    elements = np.eye(4)
    elements[3, :3] = position
    with MeshcatPage(meshcat) as view, Page(device, clock) as page:
        view.send_camera_numbers(elements.ravel().tolist())
        end = time.monotonic() + 0.3
        while time.monotonic() < end:
            clock.now_s += 0.1
            device.read()
            time.sleep(0.02)
        page.say({"do": "move", "by": [0.05, 0.0, 0.0]})
        page.say({"do": "turn", "by": [0.1, 0.2, 0.0]})
        report = page.hear("frame", lambda report: True)
        p, _ = settle(device, clock)
    np.testing.assert_allclose(p, [0.05 * HEIGHT_M, 0, 0], atol=1e-9)
    assert np.isfinite(report["handle"]).all()


def test_a_leap_of_the_pointer_is_no_leap_of_the_handle(device, clock):
    with Page(device, clock) as page:
        page.say({"do": "move", "by": [0.1, 0.0, 0.0]})
        before = device.read()
        for _ in range(300):
            clock.now_s += 0.001
            reading = device.read()
            way = np.linalg.norm(reading.X_BH[4:] - before.X_BH[4:])
            assert way <= 0.5e-3 + 1e-12
            before = reading


def test_the_handle_stays_in_its_workspace(device, clock):
    with Page(device, clock) as page:
        for _ in range(3):
            page.say({"do": "move", "by": [1.0, 1.0, 1.0]})
        p, _ = settle(device, clock)
        assert np.linalg.norm(p) == pytest.approx(RADIUS_M)
        # And comes back at once.
        page.say({"do": "move", "by": [-0.05, 0.0, 0.0]})
        back = settle(device, clock)[0] - p
    assert back[0] < -0.01


def test_home_is_where_it_started(device, clock):
    with Page(device, clock) as page:
        page.say({"do": "move", "by": [0.1, 0.2, -0.1]})
        page.say({"do": "turn", "by": [0.4, -0.2, 0.3]})
        settle(device, clock)
        page.say({"do": "home"})
        p, turn = settle(device, clock)
    np.testing.assert_allclose(p, 0, atol=1e-9)
    np.testing.assert_allclose(turn, 0, atol=1e-9)


@pytest.mark.parametrize(
    "nonsense",
    ["", "{}", '{"do": "move", "by": [NaN, 0, 0]}', {"do": "move", "by": [7, 0, 0]},
     {"do": "fly"}, b"\x00\xff"],
)  # fmt: skip
def test_what_a_page_must_not_say_is_counted_and_moves_nothing(device, clock, nonsense):
    with Page(device, clock) as page:
        page.say(nonsense)
        p, turn = settle(device, clock)
        assert device.get_link_status().rejected == 1
        np.testing.assert_allclose([*p, *turn], 0, atol=1e-9)
        # It is heard further.
        page.say({"do": "move", "by": [0.01, 0.0, 0.0]})
        assert device.get_link_status().received == 1


def test_only_one_page_drives(device, clock):
    with Page(device, clock) as first, Page(device, clock) as second:
        second.hear("frame", lambda report: report["drives"])
        first.say({"do": "move", "by": [0.1, 0.0, 0.0]})
        assert device.get_link_status().rejected == 1
        np.testing.assert_allclose(settle(device, clock)[0], 0, atol=1e-9)
        first.say({"do": "take"})
        second.hear("frame", lambda report: not report["drives"])
        first.say({"do": "move", "by": [0.1, 0.0, 0.0]})
        assert settle(device, clock)[0][0] > 0.01


def test_without_its_page_the_handle_stays_and_goes_on_being_read(device, clock):
    with Page(device, clock) as page:
        page.say({"do": "move", "by": [0.05, 0.0, 0.0]})
        p, _ = settle(device, clock)
    before = device.read()
    for _ in range(20):
        clock.now_s += 0.05
        reading = device.read()
    assert reading.sequence == before.sequence + 20
    np.testing.assert_allclose(settle(device, clock)[0], p, atol=1e-12)
    # A page that comes later takes over from there.
    with Page(device, clock) as page:
        page.say({"do": "move", "by": [0.05, 0.0, 0.0]})
        np.testing.assert_allclose(settle(device, clock)[0], 2 * p, atol=1e-9)


def test_a_page_is_told_the_wrench_as_its_picture_shows_it(device, clock):
    reading = device.read()
    # 1 N to the right, 2 up, 3 towards the viewer, who looks along y.
    f_W, tau_W = np.array([1.0, -3.0, 2.0]), np.array([0.0, -0.2, 0.1])
    R_BW = X_WB.rotation().inverse()
    F_Ho_B = np.concatenate([R_BW @ tau_W, R_BW @ f_W])
    with Page(device, clock) as page:
        assert page.hear("frame", lambda report: True)["gate"] == "idle"
        device.write(DeviceCommand(F_Ho_B, reading.X_BH, reading.V_BH))
        report = page.hear("frame", lambda report: report["gate"] == "active")
        np.testing.assert_allclose(report["f"], [1, 2, 3], atol=1e-12)
        np.testing.assert_allclose(report["tau"], [0, 0.1, 0.2], atol=1e-12)
        np.testing.assert_allclose(report["handle"], [0, 0], atol=1e-12)
        page.say({"do": "move", "by": [0.07, -0.03, 0.0]})
        settle(device, clock)
        report = page.hear("frame", lambda report: report["handle"][0] > 0.06)
        np.testing.assert_allclose(report["handle"], [0.07, -0.03], atol=1e-9)


def test_a_wrench_that_is_none_is_shown_as_zero(device, clock):
    """JSON has no word for it: a page would fail to read the report."""
    reading = device.read()
    with Page(device, clock) as page:
        F_Ho_B = np.array([0.0, np.inf, 0, np.nan, 1, 1])
        device.write(DeviceCommand(F_Ho_B, reading.X_BH, reading.V_BH))
        report = page.hear("frame", lambda report: report["gate"] == "active")
    assert report["f"] == report["tau"] == [0, 0, 0]


def test_close_ends_at_no_force_and_tells_the_page(meshcat, clock):
    device = make(meshcat)
    with Page(device, clock) as page:
        reading = device.read()
        device.write(DeviceCommand(np.ones(6), reading.X_BH, reading.V_BH))
        page.hear("frame", lambda report: report["gate"] == "active")
        device.close()
        page.hear("over", lambda over: over["why"] == "The run has ended.")
    device.close()
    device.write(DeviceCommand(np.ones(6), reading.X_BH, reading.V_BH))
    reading = device.read()
    assert reading.gate is GateState.IDLE
    np.testing.assert_array_equal(reading.F_Ho_B, np.zeros(6))


def test_nothing_holds_it_after_its_end(meshcat, clock):
    device = make(meshcat)
    with Page(device, clock) as page:
        page.say({"do": "move", "by": [0.1, 0.0, 0.0]})
        settle(device, clock)
    device.close()
    gone = weakref.ref(device)
    gc.disable()
    try:
        del device, page
        assert gone() is None
    finally:
        gc.enable()


def test_a_port_in_use_is_refused(meshcat, device):
    port = int(device.url.rstrip("/").rpartition(":")[2])
    with pytest.raises(HapticsError, match=str(port)):
        make(meshcat, port=port)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("workspace_radius_m", [0.0, -1.0, np.nan, np.inf]),
        ("max_force_N", [-1.0, np.nan, np.inf]),
        ("max_torque_Nm", [-1.0, np.nan, np.inf]),
    ],
)
def test_a_number_out_of_range_is_refused(meshcat, name, values):
    for value in values:
        with pytest.raises(ValueError, match=name):
            make(meshcat, **{name: value})
