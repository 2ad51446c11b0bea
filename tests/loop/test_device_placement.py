"""A user's device in a scene: where it stands, and that the loop closes."""

from dataclasses import replace

import numpy as np
import pytest
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import read_output
from fake_device import ScriptedDevice, make_reading
from pydrake.math import RigidTransform

from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.device.backend import DeviceError, LinkStatus
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.device_placement import find_device_site, wait_for_reading
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import Pose, Scene, Waypoint
from drake_haptics.simulation.run import run

START = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.02)


def device_at(scene: Scene, *heights_m: float) -> ScriptedDevice:
    """Returns a device that holds the tool at heights over the plate, tick by tick."""
    X_WB = find_device_site(scene).X_WB
    X_TH = scene.tool.grasp.to_rigid_transform().inverse()

    def read(call):
        z = PLATE_TOP + TOOL_HALF_HEIGHT + heights_m[min(call, len(heights_m)) - 1]
        X_BH = X_WB.inverse() @ RigidTransform([0.0, 0.0, z]) @ X_TH
        q_BH = pose_to_vector(X_BH)
        return make_reading(call, position=q_BH[4:], wxyz=q_BH[:4])

    return ScriptedDevice(read)


@pytest.fixture
def scene(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.tool.grasp = Pose([0.0, 0.0, -0.03], [0.0, 0.0, 20.0])
    scene.device.base = Pose([-0.2, 0.01, 0.2], [0.0, 0.0, 5.0])
    return scene


def test_the_site_puts_the_tool_where_the_path_starts(scene):
    site = find_device_site(scene)
    X_WT = site.X_WB @ site.X_BH @ scene.tool.grasp.to_rigid_transform()
    z = START[3] + PLATE_TOP
    assert X_WT.IsNearlyEqualTo(RigidTransform([0.0, 0.0, z]), 1e-12)
    preset = load_device_preset(scene.device.preset)
    assert site.workspace_radius_m == preset.workspace_radius_m


def test_the_tool_starts_where_the_device_holds_it(scene):
    """Not where the scene's hand would start: that hand holds nothing here."""
    haptic = BuildHapticDiagram(scene, device=device_at(scene, 0.004))
    root = haptic.diagram.CreateDefaultContext()
    X_WT = vector_to_pose(read_output(haptic.loop.haptic_tool, "X_WT", root))
    expected = RigidTransform([0.0, 0.0, PLATE_TOP + TOOL_HALF_HEIGHT + 0.004])
    assert X_WT.IsNearlyEqualTo(expected, 1e-12)


def test_a_device_pressed_into_the_plate_is_pushed_out(scene):
    """Truth: coupling and contact in series, the contact from its tolerance on."""
    depth, tolerance = 2e-3, 0.5e-3
    scene.contact.tolerance_m = tolerance
    backend = device_at(scene, *np.linspace(0.001, -depth, 200))
    run(BuildHapticDiagram(scene, device=backend), 1.0)
    K, k = scene.coupling.stiffness_N_per_m, scene.contact.stiffness_N_per_m
    X_WB = find_device_site(scene).X_WB
    f_W = X_WB.rotation() @ backend.commands[-1].F_Ho_B[3:]
    # Four corners press: clustering shares one spring among them.
    np.testing.assert_allclose(
        f_W, [0, 0, (depth + tolerance) * K * k / (K + k)], rtol=1e-3, atol=1e-4
    )


def test_what_is_written_says_how_the_wrench_goes_on(scene):
    """Truth: coupling and contact in series along the normal, and nothing in air."""
    scene.tool.grasp = Pose()
    X_WB = find_device_site(scene).X_WB
    R = np.kron(np.eye(2), X_WB.rotation().matrix())
    press = device_at(scene, *np.linspace(0.001, -2e-3, 200))
    run(BuildHapticDiagram(scene, device=press), 1.0)
    K, k = scene.coupling.stiffness_N_per_m, scene.contact.stiffness_N_per_m
    slopes = R @ press.commands[-1].K_B @ R.T
    assert slopes[5, 5] == pytest.approx(K * k / (K + k), rel=1e-9)
    assert slopes[3, 3] == pytest.approx(0.0, abs=1e-6 * K), "it slides on the plate"
    air = device_at(scene, 0.02)
    run(BuildHapticDiagram(scene, device=air), 0.01)
    assert np.abs(air.commands[-1].K_B).max() < 1e-6
    assert np.abs(air.commands[-1].B_B).max() < 1e-6


def test_what_is_written_is_within_the_device_limits(scene):
    scene.device.max_force_N, scene.device.max_torque_Nm = 0.3, 0.001
    backend = device_at(scene, *np.linspace(0.001, -0.02, 100))
    run(BuildHapticDiagram(scene, device=backend), 0.5)
    wrenches = np.array([command.F_Ho_B for command in backend.commands])
    forces = np.linalg.norm(wrenches[:, 3:], axis=1)
    assert forces.max() == pytest.approx(0.3)
    assert np.linalg.norm(wrenches[:, :3], axis=1).max() <= 0.001 + 1e-15


def test_a_device_of_which_no_model_is_known_needs_none(scene):
    scene.device.preset, scene.device.base = "omega_6", None
    backend = device_at(scene, 0.01)
    haptic = BuildHapticDiagram(scene, device=backend)
    assert haptic.backend is backend
    assert haptic.loop.device.max_torque_Nm == 0.0


def test_without_a_base_the_handle_starts_where_the_path_does(scene):
    """Wherever on its desk an unknown arm is held; its axes stay those of the world."""
    scene.device.base = None
    read_first = make_reading(position=(3.0, -2.0, 1.0), wxyz=(0.6, 0.0, 0.0, 0.8))
    haptic = BuildHapticDiagram(scene, device=ScriptedDevice(lambda _: read_first))
    root = haptic.diagram.CreateDefaultContext()
    q_WH = read_output(haptic.loop.device, "X_WH", root)
    X_TH = scene.tool.grasp.to_rigid_transform().inverse()
    start = RigidTransform([0.0, 0.0, START[3] + PLATE_TOP]) @ X_TH
    np.testing.assert_allclose(q_WH[4:], start.translation(), atol=1e-12)
    np.testing.assert_allclose(q_WH[:4], [0.6, 0.0, 0.0, 0.8], atol=1e-12)


def test_a_device_that_knows_its_place_is_left_there(scene):
    class Placed(ScriptedDevice):
        is_placed = True

    scene.device.base = None
    reading = make_reading(position=(0.3, -0.2, 0.1))
    haptic = BuildHapticDiagram(scene, device=Placed(lambda _: reading))
    root = haptic.diagram.CreateDefaultContext()
    expected = find_device_site(scene).X_WB @ np.array([0.3, -0.2, 0.1])
    q_WH = read_output(haptic.loop.device, "X_WH", root)
    np.testing.assert_allclose(q_WH[4:], expected, atol=1e-12)


def test_a_small_device_is_not_refused_for_a_path_that_nobody_follows(scene):
    scene.device.base = None
    scene.device.preset = "falcon"
    far = Waypoint(time_s=5.0, position_m=[0.3, 0.0, 0.1])
    scene.hand.path.waypoints.append(far)
    BuildHapticDiagram(scene, device=ScriptedDevice())


def test_an_address_is_no_device_yet(scene):
    with pytest.raises(
        TypeError, match=r"is the str .*; `open_device` opens an address"
    ):
        BuildHapticDiagram(scene, device="udp://127.0.0.1:7400")


def test_no_energy_is_booked_for_a_device_that_nobody_simulates(scene):
    haptic = BuildHapticDiagram(scene, device=device_at(scene, 0.01))
    with pytest.raises(ValueError, match="energy can be recorded for a simulated"):
        run(haptic, 0.01, energy=True)


def test_a_silent_device_is_an_error_that_says_what_to_do():
    silent = ScriptedDevice(lambda _: None)
    with pytest.raises(DeviceError, match=r"sent nothing for 0.05 s.*service running"):
        wait_for_reading(silent, timeout_s=0.05)
    assert silent.reads > 1


def test_a_device_whose_words_are_all_refused_is_not_called_silent():
    class Garbled(ScriptedDevice):
        def get_link_status(self):
            return LinkStatus(rejected=7)

    with pytest.raises(DeviceError, match=r"7 packets came and were refused.*length 1"):
        wait_for_reading(Garbled(lambda _: None), timeout_s=0.05)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"X_BH": np.zeros(3)}, "X_BH .* must be 7 finite numbers"),
        ({"X_BH": [1.0, 0, 0, 0, 0, 0, 0]}, "X_BH .* must be .* in an array"),
        ({"F_Ho_B": np.zeros(3)}, "F_Ho_B .* must be 6 numbers"),
        ({"V_BH": np.full(6, np.nan)}, "V_BH .* must be 6 finite numbers"),
        ({"X_BH": np.zeros(7)}, "quaternion .* length 1, has 0"),
        ({"X_BH": np.array([0.9, 0, 0, 0, 0, 0, 0])}, "length 1, has 0.9"),
    ],
)
def test_a_backend_that_tells_no_pose_or_velocity_is_told_so(wrong, words):
    device = ScriptedDevice(lambda call: replace(make_reading(call), **wrong))
    with pytest.raises(ValueError, match=words):
        wait_for_reading(device)


def test_the_first_reading_is_waited_for():
    late = ScriptedDevice(lambda call: make_reading(call) if call > 2 else None)
    assert wait_for_reading(late).sequence == 3
