"""A real pointer in a real browser moves the handle, and its page shows the force."""

import re
import time

import numpy as np
import pytest
from headless_browser import HeadlessBrowser
from pydrake.geometry import Box, Rgba, Sphere
from pydrake.math import RigidTransform, RotationMatrix

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.device.backend import DeviceCommand
from drake_haptics.visualization.meshcat import start_meshcat
from drake_haptics.web.mouse_device import MouseDevice

BOUND_S = 180.0
X_WB = RigidTransform(RotationMatrix.MakeZRotation(2.0), [0.3, 0.0, 0.1])
X_WH = RigidTransform([0.02, 0.01, 0.05])
F_W = np.array([0.0, 0.06, 0.08, 1.0, -2.0, 2.0])
CAMERA_M = np.array([0.3, -0.45, 0.3])
SHIFT = 8
# Counts what the page asks for.
COUNT = """
  window.sent = 0;
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function(text) {
    sent += JSON.parse(text).do != "seen";
    send.call(this, text);
  };
"""
# Where the picture is in the window, px: it is larger, so that its middle is free.
PICTURE = """(({left, top, width, height}) => [left, top, width, height])(
  document.getElementById('layer').getBoundingClientRect())"""
PRESSED = """[...document.querySelectorAll('#pointer [aria-pressed=true]')]
  .map(button => button.id)"""
RING = """['cx', 'cy'].map(a =>
  Number(document.getElementById('ring').getAttribute(a)))"""


class Hand:
    """A pointer on the page, while the device's loop goes on."""

    def __init__(self, meshcat, device, browser):
        self.meshcat, self.device, self.browser = meshcat, device, browser
        self.rests = True

    def read(self):
        """One turn of the loop; returns X_WH."""
        reading = self.device.read()
        R_BW = X_WB.rotation().inverse()
        F_Ho_B = np.concatenate([R_BW @ F_W[:3], R_BW @ F_W[3:]])
        self.device.write(DeviceCommand(F_Ho_B, reading.X_BH, reading.V_BH))
        self.rests = np.abs(reading.V_BH).max() < 1e-7
        return X_WB @ vector_to_pose(reading.X_BH)

    def wait_for(self, wanted):
        """Goes on until something is true."""
        end = time.monotonic() + BOUND_S
        while not wanted():
            assert time.monotonic() < end
            self.read()
            time.sleep(0.005)

    def wait_for_pictures(self, count):
        """Waits until the page has drawn so many more."""
        self.browser.evaluate(
            f"window.left = {count};"
            " (draw => requestAnimationFrame(draw))("
            "function draw() { left -= 1; if (left > 0) requestAnimationFrame(draw); })"
        )
        self.wait_for(lambda: self.browser.evaluate("left") <= 0)

    def wait_for_still_camera(self):
        """Goes on until the loop has the camera of pictures that no longer change."""
        seen = [None]

        def stands_still():
            seen.append(self.meshcat.GetTrackedCameraPose())
            self.wait_for_pictures(5)
            return seen[-2] is not None and seen[-1].IsExactlyEqualTo(seen[-2])

        self.wait_for(stands_still)

    def rest(self):
        """Goes on until the handle has done all that was asked; returns X_WH."""
        # The page sends what was asked with its next frame.
        self.wait_for_pictures(2)
        sent = self.browser.evaluate("sent")
        self.wait_for(lambda: self.device.get_link_status().received == sent)
        # It sets off with the reading that takes the goal, and is under way soon after.
        self.read()
        time.sleep(0.02)
        self.read()
        self.wait_for(lambda: self.rests)
        return self.read()

    def find(self, X):
        """Where Meshcat's camera of 75 degrees sees a pose's origin, px."""
        X_WC = self.meshcat.GetTrackedCameraPose()
        x, y, z = X_WC.inverse() @ X.translation()
        left, top, width, height = self.browser.evaluate(PICTURE)
        scale = height / (2 * z * np.tan(np.deg2rad(37.5)))
        return np.array([left + width / 2 + scale * x, top + height / 2 + scale * y])

    def ring(self):
        """Where the page marks the handle, px."""
        left, top, *_ = self.browser.evaluate(PICTURE)
        return np.array([left, top]) + self.browser.evaluate(RING)

    def text(self, name):
        """What a part of the page says."""
        return self.browser.evaluate(f"document.getElementById('{name}').textContent")

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
def hand(chromium):
    """The page, open, of a camera that looks askance."""
    meshcat = start_meshcat()
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
        HeadlessBrowser(chromium) as browser,
    ):
        browser.open(device.url)
        browser.evaluate(COUNT)
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
    hand.drag((400, 250), (480, 200))
    X = hand.rest()
    np.testing.assert_allclose(hand.find(X) - hand.find(X_WH), [80, -50], atol=0.01)
    X_WC = hand.meshcat.GetTrackedCameraPose()
    depths = [(X_WC.inverse() @ p.translation())[2] for p in (X, X_WH)]
    assert depths[0] == pytest.approx(depths[1], abs=1e-6)
    np.testing.assert_allclose(X.rotation().matrix(), np.eye(3), atol=1e-9)
    hand.wait_for(lambda: np.abs(hand.ring() - hand.find(X)).max() < 0.1)


def test_the_ring_marks_the_handle_in_meshcats_own_picture(hand):
    """A ball put where the handle is has its middle in the ring."""
    ball = Rgba(1.0, 0.0, 1.0)
    hand.drag((400, 250), (300, 220))
    X = hand.rest()
    hand.wait_for(lambda: np.abs(hand.ring() - hand.find(X)).max() < 0.1)
    # Else it might be seen where it is before it has a place.
    hand.meshcat.SetTransform("/ball", X)
    hand.meshcat.SetObject("/ball", Sphere(0.012), ball)
    try:
        hand.wait_for(lambda: magenta(hand.browser.screenshot()).any())
        rows, columns = np.nonzero(magenta(hand.browser.screenshot()))
        middle = np.array([columns.mean(), rows.mean()])
        np.testing.assert_allclose(middle, hand.ring(), atol=2.5)
    finally:
        hand.meshcat.Delete("/ball")


def magenta(picture):
    """Where a picture is of the ball's color."""
    red, green, blue = picture.astype(int).transpose(2, 0, 1)
    return (np.minimum(red, blue) - green) > 100


@pytest.mark.parametrize(("notch", "sign"), [(-100, 1), (100, -1)])
def test_the_wheel_pushes_away_and_pulls_near(hand, notch, sign):
    hand.mouse("mouseWheel", 400, 300, deltaX=0, deltaY=notch)
    away = hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 2]
    way = hand.rest().translation() - X_WH.translation()
    np.testing.assert_allclose(way / np.linalg.norm(way), sign * away, atol=1e-6)


@pytest.mark.parametrize("options", [{"modifiers": SHIFT}, {"button": "right"}])
def test_shift_or_the_right_button_turns(hand, options):
    hand.drag((400, 300), (450, 300), **options)
    X = hand.rest()
    np.testing.assert_allclose(X.translation(), X_WH.translation(), atol=1e-6)
    height = hand.browser.evaluate(PICTURE)[3]
    turn = X.rotation().ToAngleAxis()
    assert turn.angle() == pytest.approx(np.pi * 50 / height, abs=1e-3)
    up = -hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 1]
    np.testing.assert_allclose(turn.axis(), up, atol=1e-5)


def touch(hand, *fingers):
    """Moves fingers, each through points at the same times."""
    for step, points in enumerate(zip(*fingers, strict=True)):
        hand.browser.call(
            "Input.dispatchTouchEvent",
            type="touchMove" if step else "touchStart",
            touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)],
        )
    hand.browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])


def test_a_finger_moves_it(hand):
    touch(hand, [(400, 250), (440, 250), (460, 250)])
    right = hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 0]
    way = hand.rest().translation() - X_WH.translation()
    np.testing.assert_allclose(way / np.linalg.norm(way), right, atol=1e-6)


def test_fingers_that_spread_pull_it_near(hand):
    touch(
        hand, [(400, 250), (380, 250), (360, 250)], [(440, 250), (460, 250), (480, 250)]
    )
    X = hand.rest()
    near = -hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 2]
    way = X.translation() - X_WH.translation()
    np.testing.assert_allclose(way / np.linalg.norm(way), near, atol=1e-6)
    np.testing.assert_allclose(X.rotation().matrix(), np.eye(3), atol=1e-6)


def test_two_fingers_turn_it(hand):
    touch(
        hand, [(400, 250), (400, 240), (400, 220)], [(440, 250), (440, 240), (440, 220)]
    )
    X = hand.rest()
    turn = X.rotation().ToAngleAxis()
    height = hand.browser.evaluate(PICTURE)[3]
    assert turn.angle() == pytest.approx(np.pi * 30 / height, abs=1e-3)
    # The near side goes up: about the axis that points to the left.
    right = hand.meshcat.GetTrackedCameraPose().rotation().matrix()[:, 0]
    np.testing.assert_allclose(turn.axis(), -right, atol=1e-5)


def test_the_pointer_can_be_handed_to_the_camera_and_back(hand):
    before = hand.meshcat.GetTrackedCameraPose()
    hand.press("c")
    assert hand.browser.evaluate(PRESSED) == ["to-camera"]
    for _ in range(2):
        hand.drag((400, 300), (440, 300))
    hand.wait_for(
        lambda: not hand.meshcat.GetTrackedCameraPose().IsNearlyEqualTo(before, 1e-2)
    )
    hand.wait_for_still_camera()
    assert hand.rest().IsNearlyEqualTo(X_WH, 1e-6)
    # The key is heard though the pointer was last in Meshcat's own page.
    hand.press("c")
    hand.browser.wait_for(f"{PRESSED}[0] == 'to-handle'")
    # What is dragged now goes as the new camera sees it.
    hand.drag((400, 250), (440, 250))
    X = hand.rest()
    np.testing.assert_allclose(hand.find(X) - hand.find(X_WH), [40, 0], atol=0.01)


def test_the_force_is_told(hand):
    for name, wanted in [
        ("force", "3.00 N"),
        ("torque", "100 mN·m"),
        ("gate", "active"),
    ]:
        hand.wait_for(lambda name=name, wanted=wanted: hand.text(name) == wanted)
    cells = "[...document.querySelectorAll('#components td')].map(c => c.textContent)"
    assert hand.browser.evaluate(cells)[1:] == [
        "1.00", "0", "−2.00", "60", "2.00", "80",
    ]  # fmt: skip


def test_the_dial_has_the_force_as_the_picture_has_it(hand):
    """Half of the device's limit is half of the rim."""
    hand.wait_for(lambda: hand.text("force") == "3.00 N")
    X_WC = hand.meshcat.GetTrackedCameraPose()
    wanted = 45 / 6.0 * (X_WC.rotation().inverse() @ F_W[3:])
    path = hand.browser.evaluate("document.getElementById('dial-arrow').outerHTML")
    x, y = (float(word) for word in re.search(r"L(\S+) (\S+?)M", path).groups())
    depth = "document.getElementById('dial-depth')"
    radius = float(hand.browser.evaluate(f"{depth}.getAttribute('r')"))
    is_away = hand.browser.evaluate(f"{depth}.classList.contains('away')")
    # In a camera's frame z points away from the viewer.
    np.testing.assert_allclose([x, y, radius if is_away else -radius], wanted, atol=0.1)


def test_nothing_is_amiss_on_the_page(hand):
    """Also while nothing is heard of the loop, as here."""
    hand.browser.wait_for("document.getElementById('notice-quiet') != null")
    assert hand.browser.errors == []
    # There is nothing to be changed, and no figure that nobody knows.
    assert hand.browser.evaluate(
        "['right', 'cameras', 'take-handle', 'actions'].every("
        "id => !document.getElementById(id).offsetWidth)"
    )
    shown = "[...document.querySelectorAll('#figures > div')].filter(d => !d.hidden)"
    assert hand.browser.evaluate(f"{shown}.map(d => d.querySelector('dd').id)") == [
        "time", "rate",
    ]  # fmt: skip


def test_the_page_says_when_the_run_has_ended(hand):
    """Last of all."""
    hand.device.close()
    hand.browser.wait_for("document.getElementById('notice-over') != null")
    assert "has ended" in hand.text("notice-over")
    assert hand.text("gate") == "ended"
