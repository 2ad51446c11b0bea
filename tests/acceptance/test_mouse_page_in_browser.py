"""A real pointer in a real browser moves the handle, and its page shows the force."""

import time

import numpy as np
import pytest
from headless_browser import HeadlessBrowser, find_browser
from pydrake.geometry import Box, Rgba, Sphere
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics.colors import COUPLING_LINE
from drake_haptics.device.backend import DeviceCommand
from drake_haptics.device.mouse_device import MouseDevice
from drake_haptics.pose_vector import vector_to_pose
from drake_haptics.stage import open_meshcat

BOUND_S = 30.0
X_WB = RigidTransform(RotationMatrix.MakeZRotation(2.0), [0.3, 0.0, 0.1])
X_WH = RigidTransform([0.02, 0.01, 0.05])
F_W = np.array([0.0, 0.06, 0.08, 1.0, -2.0, 2.0])
CAMERA_M = np.array([0.3, -0.45, 0.3])
SHIFT = 8
RING = "['cx', 'cy'].map(a => Number(document.getElementById('ring').getAttribute(a)))"


class Hand:
    """A pointer on the page, while the device's loop goes on."""

    def __init__(self, meshcat, device, browser):
        self.meshcat, self.device, self.browser = meshcat, device, browser

    def read(self):
        """One turn of the loop; returns X_WH."""
        reading = self.device.read()
        F_BH = np.concatenate(
            [X_WB.rotation().inverse() @ f for f in (F_W[:3], F_W[3:])]
        )
        self.device.write(DeviceCommand(F_BH, reading.X_BH, reading.V_BH))
        return X_WB @ vector_to_pose(reading.X_BH)

    def wait_for(self, wanted):
        """Goes on until something is true."""
        end = time.monotonic() + BOUND_S
        while not wanted():
            assert time.monotonic() < end
            self.read()
            time.sleep(0.01)

    def rest(self):
        """Goes on until the handle has arrived; returns X_WH."""
        before = None
        end = time.monotonic() + BOUND_S
        while time.monotonic() < end:
            for _ in range(20):
                X = self.read()
                time.sleep(0.01)
            if before is not None and X.IsNearlyEqualTo(before, 1e-7):
                return X
            before = X
        raise AssertionError("the handle does not rest")

    def ring(self):
        """Where the page marks the handle, px."""
        return np.array(self.browser.evaluate(RING))

    def mouse(self, kind, x, y, **options):
        """Does something with the mouse."""
        self.browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **options)

    def drag(self, begin, end, button="left", **options):
        """Drags from one pixel to another."""
        options |= {"button": button}
        buttons = {"left": 1, "right": 2}[button]
        self.mouse("mouseMoved", *begin)
        self.mouse("mousePressed", *begin, buttons=buttons, clickCount=1, **options)
        for share in np.linspace(0.1, 1.0, 10):
            x, y = (1 - share) * np.array(begin) + share * np.array(end)
            self.mouse("mouseMoved", x, y, buttons=buttons, **options)
            self.read()
        self.mouse("mouseReleased", *end, clickCount=1, **options)

    def press(self, key):
        """Presses a letter's key."""
        for kind in ("keyDown", "keyUp"):
            self.browser.call(
                "Input.dispatchKeyEvent",
                type=kind, key=key, text=key, code=f"Key{key.upper()}",
            )  # fmt: skip


@pytest.fixture(scope="module")
def hand():
    """The page, open, of a camera that looks askance."""
    executable = find_browser()
    if executable is None:
        pytest.skip("no Chromium on the PATH")
    meshcat = open_meshcat()
    meshcat.SetObject("/box", Box(0.1, 0.1, 0.1), Rgba(0.2, 0.7, 0.3))
    meshcat.SetCameraPose(CAMERA_M, np.zeros(3))
    with (
        MouseDevice(
            meshcat,
            X_WB=X_WB,
            X_BH=X_WB.inverse() @ X_WH,
            workspace_radius_m=0.3,
            max_force_N=6.0,
            max_torque_Nm=0.2,
        ) as device,
        HeadlessBrowser(executable) as browser,
    ):
        browser.open(device.url)
        hand = Hand(meshcat, device, browser)
        hand.wait_for(lambda: hand.meshcat.GetTrackedCameraPose() is not None)
        # Meshcat tells an orientation first that is not yet the picture's.
        away = -CAMERA_M / np.linalg.norm(CAMERA_M)
        hand.wait_for(
            lambda: np.allclose(
                hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 2], away
            )
        )
        yield hand


@pytest.fixture(autouse=True)
def home(hand):
    """Begins with the handle where it started."""
    hand.press("h")
    assert hand.rest().IsNearlyEqualTo(X_WH, 1e-6)


def test_what_is_dragged_stays_under_the_pointer(hand):
    before = hand.ring()
    hand.drag((400, 250), (480, 200))
    X = hand.rest()
    hand.wait_for(lambda: np.linalg.norm(hand.ring() - before - [80, -50]) < 0.5)
    X_WC = hand.meshcat.GetTrackedCameraPose()
    depths = [(X_WC.inverse() @ p.translation())[2] for p in (X, X_WH)]
    assert depths[0] == pytest.approx(depths[1], abs=1e-6)
    np.testing.assert_allclose(X.rotation().matrix(), np.eye(3), atol=1e-9)


def test_the_ring_marks_the_handle_in_meshcats_own_picture(hand):
    """A ball put where the handle is has its middle in the ring."""
    ball = Rgba(1.0, 0.0, 1.0)
    hand.drag((400, 250), (300, 220))
    X = hand.rest()
    hand.meshcat.SetObject("/ball", Sphere(0.012), ball)
    hand.meshcat.SetTransform("/ball", X)
    try:
        hand.wait_for(lambda: magenta(hand.browser.screenshot()).any())
        rows, columns = np.nonzero(magenta(hand.browser.screenshot()))
        middle = np.array([columns.mean(), rows.mean()])
        np.testing.assert_allclose(middle, hand.ring(), atol=2.5)
    finally:
        hand.meshcat.Delete("/ball")


def magenta(picture):
    """Where a picture is of the ball's colour."""
    red, green, blue = picture.astype(int).transpose(2, 0, 1)
    return (np.minimum(red, blue) - green) > 100


@pytest.mark.parametrize(("notch", "sign"), [(-100, 1), (100, -1)])
def test_the_wheel_pushes_away_and_pulls_near(hand, notch, sign):
    hand.mouse("mouseWheel", 400, 300, deltaX=0, deltaY=notch)
    hand.wait_for(lambda: not hand.read().IsNearlyEqualTo(X_WH, 1e-3))
    away = hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 2]
    way = hand.rest().translation() - X_WH.translation()
    np.testing.assert_allclose(way / np.linalg.norm(way), sign * away, atol=1e-6)


@pytest.mark.parametrize("options", [{"modifiers": SHIFT}, {"button": "right"}])
def test_shift_or_the_right_button_turns(hand, options):
    hand.drag((400, 300), (450, 300), **options)
    hand.wait_for(lambda: not hand.read().IsNearlyEqualTo(X_WH, 1e-3))
    X = hand.rest()
    np.testing.assert_allclose(X.translation(), X_WH.translation(), atol=1e-6)
    height = hand.browser.evaluate("innerHeight")
    turn = X.rotation().ToAngleAxis()
    assert turn.angle() == pytest.approx(np.pi * 50 / height, abs=1e-3)
    up = -hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 1]
    np.testing.assert_allclose(turn.axis(), up, atol=1e-5)


def test_a_finger_moves_it(hand):
    for kind, points in [
        ("touchStart", [{"x": 400, "y": 250}]),
        ("touchMove", [{"x": 440, "y": 250}]),
        ("touchMove", [{"x": 460, "y": 250}]),
        ("touchEnd", []),
    ]:
        hand.browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    hand.wait_for(lambda: not hand.read().IsNearlyEqualTo(X_WH, 1e-3))
    right = hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 0]
    way = hand.rest().translation() - X_WH.translation()
    np.testing.assert_allclose(way / np.linalg.norm(way), right, atol=1e-6)


def test_the_pointer_can_be_handed_to_the_camera_and_back(hand):
    before = hand.meshcat.GetTrackedCameraPose()
    hand.press("c")
    assert "Back to the handle" in hand.browser.evaluate("document.body.innerText")
    hand.drag((400, 300), (480, 300))
    hand.wait_for(
        lambda: not hand.meshcat.GetTrackedCameraPose().IsNearlyEqualTo(before, 1e-2)
    )
    assert hand.rest().IsNearlyEqualTo(X_WH, 1e-6)
    x, y = hand.browser.evaluate(
        "(box => [box.x + box.width / 2, box.y + box.height / 2])"
        "(document.getElementById('camera').getBoundingClientRect())"
    )
    hand.drag((x, y), (x, y))
    # What is dragged now goes as the new camera sees it.
    start = hand.ring()
    hand.drag((400, 250), (440, 250))
    hand.rest()
    hand.wait_for(lambda: np.linalg.norm(hand.ring() - start - [40, 0]) < 0.5)


def test_the_force_is_told(hand):
    text = "document.getElementById('{}').textContent"
    for name, wanted in [
        ("force", "3.00 N"),
        ("torque", "100 mN·m"),
        ("gate", "active: the force is shown"),
    ]:
        hand.wait_for(
            lambda name=name, wanted=wanted: (
                hand.browser.evaluate(text.format(name)) == wanted
            )
        )
    assert hand.browser.evaluate(
        "document.getElementById('force-bar').style.width"
    ) == pytest.approx("50%")
    picture = hand.browser.screenshot().astype(int)
    yellow = np.abs(picture - 255 * np.array(COUPLING_LINE[:3])).max(axis=2) < 12
    assert yellow.sum() > 200


def test_nothing_is_amiss_on_the_page(hand):
    assert hand.browser.errors == []
    # Cards lie beside each other within the window.
    assert hand.browser.evaluate(
        "(([a, b]) => a.left >= 0 && a.right < b.left && b.right <= innerWidth)"
        "(['feel', 'help'].map(id => document.getElementById(id))"
        ".map(card => card.getBoundingClientRect()))"
    )


def test_the_page_says_when_the_run_has_ended(hand):
    """Last of all."""
    hand.device.close()
    hand.browser.wait_for(
        "document.getElementById('notice').innerText.includes('has ended')"
    )
    assert hand.browser.evaluate("document.getElementById('force').textContent") == (
        "0.00 N"
    )
