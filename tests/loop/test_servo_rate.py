"""A scene that asks for contact between ticks: in Drake, and by a device's servo."""

from __future__ import annotations

import dataclasses
import time

import numpy as np
import pytest
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, over_a_plate
from fake_device import ScriptedDevice
from pydrake.math import RigidTransform
from struct_driver import ACTIVE, FAULT, IDLE, StructDriver

from drake_haptics import BuildHapticDiagram, SceneError
from drake_haptics.bounds.held_handle import check_scene_coupling
from drake_haptics.cockpit.handle_holder import take_device
from drake_haptics.device.backend import DeviceError, GateState
from drake_haptics.device.udp_device import UdpDevice
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.schema import Pose
from drake_haptics.scene.settings import change_scene
from drake_haptics.simulation.run import make_simulator

ABOVE, PRESS = TOOL_HALF_HEIGHT + 5e-3, TOOL_HALF_HEIGHT - 5e-3
SKIN_M = 3e-4
REST_M = PLATE_TOP + TOOL_HALF_HEIGHT + SKIN_M


@pytest.fixture
def scene(tmp_path):
    """A cube that comes down on a plate and is held there."""
    path = [(0.0, 0.0, 0.0, ABOVE), (0.15, 0.0, 0.0, PRESS)]
    scene = over_a_plate(tmp_path, path)
    scene.contact.law = "constraint"
    scene.device.servo_rate_hz = 4000.0
    return scene


def read_height(haptic, context):
    return haptic.diagram.GetOutputPort("X_WT").Eval(context)[6]


def test_in_drake_it_is_the_loop_of_that_rate(scene):
    """Nothing else in this scene depends on the rate: not a bit differs."""
    fast = change_scene(scene, ["device.servo_rate_hz=", "device.rate_hz=4000"])
    states = []
    for each in (scene, fast):
        haptic = BuildHapticDiagram(each)
        simulator = make_simulator(haptic)
        simulator.Initialize()
        simulator.AdvanceTo(0.1)
        context = simulator.get_context()
        names = ("X_WT", "F_Ho_W_rendered", "X_WH")
        states.append(
            [haptic.diagram.GetOutputPort(name).Eval(context).copy() for name in names]
        )
    np.testing.assert_array_equal(np.hstack(states[0]), np.hstack(states[1]))
    assert haptic.period_s == 1 / 4000 and states[0][0][6] < PLATE_TOP + ABOVE


def test_the_bounds_are_those_of_its_rate(scene):
    """A coupling that is too stiff for the tick alone may be right for the servo."""
    slow = change_scene(scene, ["device.servo_rate_hz="])
    stiff = 20000.0
    broken = []
    for each in (slow, scene):
        each.coupling.stiffness_N_per_m = stiff
        device = make_simulated_device(each, make_hand_path(each.hand.path))
        broken.append(check_scene_coupling(each, device))
    assert len(broken[1]) < len(broken[0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"contact.law": "penalty"}, "under 'penalty'"),
        ({"device.servo_rate_hz": "1500"}, "2000 is the nearest"),
        ({"device.servo_rate_hz": "500"}, "1000 is the nearest"),
        ({"device.servo_rate_hz": "-1000"}, "device.servo_rate_hz"),
        ({"effects.friction": "{}"}, r"servo_rate_hz.*take effects\.friction out"),
    ],
)
def test_what_cannot_be_is_refused(scene, change, message):
    with pytest.raises(SceneError, match=message):
        change_scene(scene, [f"{key}={value}" for key, value in change.items()])


def test_a_device_without_a_servo_is_refused(scene):
    with pytest.raises(DeviceError, match=r"servo_rate_hz.*ScriptedDevice"):
        BuildHapticDiagram(scene, device=ScriptedDevice())


class Rig:
    """A scene on a device by UDP, its handle where the scene's hand starts."""

    def __init__(self, scene, driver, *, taken=False):
        scene.device.base = Pose()
        self.driver = driver
        self.X_BH = np.array([1.0, 0, 0, 0, 0, 0, PLATE_TOP + ABOVE])
        self.backend = UdpDevice(
            "127.0.0.1", driver.port, ttl_s=5.0, hold_s=5.0, max_force_N=2.0
        )
        if taken:
            self.backend = take_device(self.backend, scene)
        driver.receive()
        self.exchange(IDLE)
        self.haptic = BuildHapticDiagram(scene, device=self.backend)
        self.simulator = make_simulator(self.haptic)
        self.simulator.Initialize()

    def exchange(self, gate):
        """Answers the next command by a state, and returns the command after it."""
        return self.driver.exchange(
            gate=gate, X_BH=tuple(self.X_BH), max_force_N=8.5, max_torque_Nm=1.0
        )

    def tick(self):
        """Advances the loop by a tick; returns the height of its tool."""
        context = self.simulator.get_context()
        self.simulator.AdvanceTo(context.get_time() + 1e-3)
        return read_height(self.haptic, context)


@pytest.fixture
def driver():
    with StructDriver() as driver:
        yield driver


def wait_for(condition, rig, gate=ACTIVE, seconds=60.0):
    """Ticks and answers until something is so."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        height = rig.tick()
        command = rig.exchange(gate)
        if condition(command, height):
            return command
    pytest.fail("it did not come about")
    return None


def test_the_servos_tool_is_the_loops(scene, driver):
    rig = Rig(scene, driver)
    try:
        wait_for(lambda command, _: command.enable, rig, IDLE)
        rig.X_BH[6] = PLATE_TOP + PRESS
        command = wait_for(
            lambda command, height: (
                abs(height - REST_M) < 1e-6
                and np.linalg.norm(command.F_Ho_B[3:]) > 1.99
            ),
            rig,
        )
        link = rig.backend.get_link_status()
        assert link.solved > 0
        assert 0 <= link.solved_late <= link.solved
        # It presses with more than this host allows.
        assert np.linalg.norm(command.F_Ho_B[3:]) <= 2.0 * (1 + 1e-12)
        # The device is lost; then it is recovered, and pushed again.
        wait_for(lambda command, _: not any(command.F_Ho_B), rig, FAULT)
        rig.backend.recover()
        wait_for(lambda command, _: not command.enable, rig, FAULT)
        wait_for(lambda command, _: command.enable, rig, IDLE)
        wait_for(lambda command, _: np.linalg.norm(command.F_Ho_B[3:]) > 1.9, rig)
        # A loop that is built again goes on with the tool where it is.
        again = BuildHapticDiagram(
            scene, device=rig.backend, X_WH=RigidTransform([0.0, 0.0, 0.5])
        )
        simulator = make_simulator(again)
        simulator.Initialize()
        simulator.AdvanceTo(2e-3)
        height = read_height(again, simulator.get_context())
        assert height == pytest.approx(REST_M, abs=1e-6)
        # Without the key, the loop's own wrench is shown again.
        scene.device.servo_rate_hz = None
        rig.haptic = BuildHapticDiagram(scene, device=rig.backend)
        rig.simulator = make_simulator(rig.haptic)
        rig.simulator.Initialize()
        assert rig.backend.get_link_status().solved == 0
        rig.X_BH[6] = PLATE_TOP + ABOVE
        wait_for(lambda command, _: np.linalg.norm(command.F_Ho_B[3:]) < 0.1, rig)
        rig.X_BH[6] = PLATE_TOP + PRESS
        wait_for(lambda command, _: np.linalg.norm(command.F_Ho_B[3:]) > 1.9, rig)
    finally:
        rig.backend.close()


def test_a_device_that_is_taken_shows_its_share(scene, driver):
    """Nothing while it waits, though the tool is pressed all the time."""
    rig = Rig(scene, driver, taken=True)
    try:
        wait_for(lambda command, _: command.enable, rig, IDLE)
        rig.X_BH[6] = PLATE_TOP + PRESS
        wait_for(lambda _, height: abs(height - REST_M) < 1e-6, rig)
        assert rig.backend.waits
        for _ in range(20):
            rig.tick()
            assert not any(rig.exchange(ACTIVE).F_Ho_B)
        rig.backend.resume()
        wait_for(lambda command, _: np.linalg.norm(command.F_Ho_B[3:]) > 1.9, rig)
        assert rig.backend.read().gate == GateState.ACTIVE
    finally:
        rig.backend.close()


def test_the_key_is_in_a_file(scene):
    assert dataclasses.asdict(scene.device)["servo_rate_hz"] == 4000.0
