"""A run that is changed while it goes on, against the same made by hand."""

import copy
import dataclasses
import time

import numpy as np
import pytest
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT
from cockpit_rig import FRICTION, MOUSE, STIFFER, CockpitRig, find_tool
from driver_process import device_command, running
from fake_device import ScriptedDevice, make_reading

from drake_haptics.cockpit import cockpit_run as segments
from drake_haptics.cockpit import handle_holder
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import DeviceError, GateState
from drake_haptics.device.udp_device import UdpDevice
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import GravityParameters, Pose
from drake_haptics.scene.validation import SceneError
from drake_haptics.simulation.run import RunError, run
from drake_haptics.simulation.transfer_state import find_handle
from drake_haptics.web.messages import GATES

RETAKE = {"do": "handle", "to": "device"}
TURN = {"do": "turn", "by": [0.3, 0.0, 0.0]}


def test_nothing_asked_is_a_plain_run(make, scene):
    rig = make({}, watch=find_tool)
    figures = rig.run(0.4)
    poses = []
    haptic = BuildHapticDiagram(scene)
    plain = run(
        haptic, 0.4, on_tick=lambda root: poses.append(find_tool(haptic, root))
    ).to_dict()
    assert figures["ticks"] == plain["ticks"] == 400
    np.testing.assert_array_equal(rig.seen, poses)
    assert len(rig.haptics) == 1
    np.testing.assert_allclose(rig.page.times, 1e-3 * np.arange(1, 401), atol=1e-12)


def test_an_effect_goes_on_in_another_diagram(make, monkeypatch):
    rig = make({250: [FRICTION]}, watch=find_tool)
    build = segments.BuildHapticDiagram

    def build_slowly(scene, **options):
        rig.ticks += 80
        return build(scene, **options)

    monkeypatch.setattr(segments, "BuildHapticDiagram", build_slowly)
    figures = rig.run(0.9)
    first, second = rig.haptics
    assert first.loop.effects.friction is None
    assert second.loop.effects.friction is not None
    assert rig.last is second
    # Time and statistics go on; the duration is that of both.
    assert figures["ticks"] == 900
    np.testing.assert_allclose(rig.page.times, 1e-3 * np.arange(1, 901), atol=1e-9)
    steps = np.linalg.norm(np.diff(np.array(rig.seen)[:, 4:], axis=0), axis=1)
    assert steps.max() < 0.5e-3
    assert rig.page.states[-1]["effects"]["friction"] is True
    # To build is no stall of the loop.
    assert figures["lateness_us"]["skipped"] == 0
    # First the sliders of friction, then the legend and so on of the new diagram.
    assert len(rig.page.hellos) == 3


def test_the_mouse_takes_the_handle_where_it_is(make):
    rig = make(
        {300: [MOUSE], 400: [{"do": "move", "by": [0.0, 0.05, 0.0]}]}, watch=find_tool
    )
    rig.run(0.5)
    assert [haptic.backend for haptic in rig.haptics] == [None, rig.holder.backend]
    assert rig.page.states[-1]["handle"] == "mouse"
    steps = np.linalg.norm(np.diff(np.array(rig.seen)[:, 4:], axis=0), axis=1)
    assert steps.max() < 0.5e-3
    assert [outlook.gate for outlook in rig.page.outlooks] == [3] * 9 + [1] * 6
    assert rig.holder.pointer.get_link_status().received == 1


def test_the_simulated_hand_begins_the_scene_again(make):
    rig = make({200: [MOUSE], 300: [{"do": "handle", "to": "hand"}]})
    figures = rig.run(0.5)
    assert figures["ticks"] == 500
    np.testing.assert_allclose(rig.page.times[300:], 1e-3 * np.arange(1, 201))
    assert rig.last.backend is None


@pytest.mark.parametrize("handle", ["hand", "mouse", "sliders"])
def test_a_scene_can_begin_again_in_any_hand(make, handle):
    rig = make(
        {100: [{"do": "handle", "to": handle}], 200: [{"do": "restart"}]},
        watch=lambda haptic, root: find_handle(haptic, root).translation(),
    )
    rig.run(0.3)
    np.testing.assert_allclose(rig.page.times[200:], 1e-3 * np.arange(1, 101))
    assert rig.page.states[-1]["handle"] == handle
    np.testing.assert_allclose(rig.seen[201], rig.seen[0], atol=1e-3)


def test_what_is_asked_at_once_is_all_done(make):
    rig = make({100: [MOUSE, FRICTION, STIFFER, {"do": "restart"}]})
    rig.run(0.3)
    assert len(rig.haptics) == 2
    assert rig.last.loop.effects.friction is not None
    assert rig.last.scene.coupling.stiffness_N_per_m == 1200.0
    assert rig.page.states[-1]["handle"] == "mouse"
    np.testing.assert_allclose(rig.page.times[100:], 1e-3 * np.arange(1, 201))


def test_what_cannot_be_built_is_taken_back(make, monkeypatch):
    rig = make({100: [FRICTION], 500: [STIFFER]})

    def refuse(scene, **_):
        raise SceneError("no friction today")

    monkeypatch.setattr(segments, "BuildHapticDiagram", refuse)
    figures = rig.run(0.7)
    assert figures["ticks"] == 700
    np.testing.assert_allclose(rig.page.times, 1e-3 * np.arange(1, 701), atol=1e-9)
    assert "no friction today" in [state["error"] for state in rig.page.states]
    assert rig.page.states[-1]["changes"] == {"coupling": {"stiffness_N_per_m": 1200.0}}


@pytest.mark.parametrize("place", ["build", "begin"])
def test_ctrl_c_ends_it_also_between_two_segments(make, monkeypatch, place):
    rig = make({100: [FRICTION]})
    begin = rig.cockpit.begin

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    def begin_once(*arguments, **options):
        monkeypatch.setattr(rig.cockpit, "begin", interrupt)
        begin(*arguments, **options)

    if place == "build":
        monkeypatch.setattr(segments, "BuildHapticDiagram", interrupt)
    else:
        monkeypatch.setattr(rig.cockpit, "begin", begin_once)
    assert rig.run(None)["ticks"] == 350


def test_ctrl_c_ends_it_though_something_else_was_asked(make):
    def interrupt(haptic, root):
        if root.get_time() > 0.1995:
            raise KeyboardInterrupt

    rig = make({100: [FRICTION]}, watch=interrupt)
    assert rig.run(None)["ticks"] == 200


def fail_once(at_tick):
    """Returns what makes a run fail as a state that is not finite does."""
    ticks = []

    def watch(haptic, root):
        ticks.append(root.get_time())
        if len(ticks) == at_tick:
            raise FloatingPointError("not finite")

    return watch


def test_a_run_that_fails_of_changes_begins_again_without_them(make):
    rig = make({100: [STIFFER, FRICTION]}, watch=fail_once(600))
    assert rig.run(0.8)["ticks"] == 800
    np.testing.assert_allclose(rig.page.times[-200:], 1e-3 * np.arange(1, 201))
    assert rig.last.scene == rig.changes.file
    assert "not finite" in rig.page.states[-1]["error"]


def test_a_run_that_fails_by_itself_is_over(make, device):
    rig = make({}, watch=fail_once(100))
    with pytest.raises(RunError, match="not finite"):
        rig.run(0.3)
    # And so is one that somebody feels.
    rig = make({50: [STIFFER]}, watch=fail_once(100), address="udp://there")
    with pytest.raises(RunError, match="not finite"):
        rig.run(0.3)


@pytest.fixture
def device(monkeypatch):
    """A device whose handle moves on, wherever its base stands."""
    opened = []

    def open_device(address, scene, meshcat):
        opened.append(
            ScriptedDevice(lambda k: make_reading(k, position=(1e-6 * k, 0, 0)))
        )
        return opened[-1]

    monkeypatch.setattr(handle_holder, "open_device", open_device)
    return opened


def test_a_device_stays_where_it_was_put(make, device):
    """Its base is put so that the handle is where the scene starts, once."""
    rig = make(
        {200: [FRICTION], 600: [{"do": "restart"}]},
        address="udp://there",
        watch=lambda haptic, root: find_handle(haptic, root).translation(),
    )
    rig.run(0.8)
    assert len(device) == 1 and not device[0].closed
    assert len(rig.haptics) == 3
    steps = np.linalg.norm(np.diff(rig.seen, axis=0), axis=1)
    assert steps.max() < 50e-6
    assert rig.page.hellos[0]["handles"][-1] == {
        "name": "device",
        "label": "udp://there",
    }


def test_a_device_is_let_go_and_taken_again(make, device):
    rig = make({100: [MOUSE], 200: [RETAKE]}, address="udp://there")
    rig.run(0.3)
    assert [opened.closed for opened in device] == [True, False]
    assert rig.last.backend.device is device[1]


def test_a_scene_without_a_simulated_device_has_no_simulated_hand(
    scene, meshcat, monkeypatch, device
):
    """Its hand's path is out of the device's reach."""
    far = copy.deepcopy(scene)
    far.hand.path.waypoints[1].position_m = [9.0, 0.0, 0.0]
    rig = CockpitRig(
        far, meshcat, monkeypatch, {10: [{"do": "handle", "to": "hand"}]},
        address="udp://there",
    )  # fmt: skip
    assert rig.run(0.2)["ticks"] == 200
    assert "hand" not in {item["name"] for item in rig.page.hellos[0]["handles"]}
    assert "no holder called 'hand'" in rig.page.states[-1]["error"]


def test_a_device_that_is_gone_leaves_the_handle_where_it_is(make, monkeypatch, device):
    rig = make({100: [MOUSE], 200: [RETAKE]}, address="udp://there")

    def fail(address, scene, meshcat):
        raise DeviceError("the device has said nothing")

    monkeypatch.setattr(handle_holder, "open_device", fail)
    rig.run(0.3)
    assert rig.page.states[-1]["error"] == "the device has said nothing"
    assert rig.last.backend is rig.holder.pointer is not None


def test_a_driver_bears_the_pause_of_a_rebuild(make, monkeypatch, tmp_path, meshcat):
    """The servo's thread goes on: the gate is at no fault, and the force comes back."""
    file = tmp_path / "figures.json"
    with running(device_command(file, "--ttl-ms", 1000), file) as driver:
        # What it shows without a host for so long would be a fault.
        monkeypatch.setattr(
            handle_holder,
            "open_device",
            lambda *_: UdpDevice("127.0.0.1", driver.port, ttl_s=1.0),
        )
        build = segments.BuildHapticDiagram

        def build_slowly(scene, **options):
            time.sleep(1.2)
            return build(scene, **options)

        monkeypatch.setattr(segments, "BuildHapticDiagram", build_slowly)
        gates = []
        rig = make(
            {100: [FRICTION]},
            address="udp://there",
            watch=lambda *_: gates.append(rig.holder.backend.read().gate),
        )
        rig.run(0.8, pace=RealTimePacer(rig.period_s))
        rig.holder.close()
        figures = driver.end()
    assert len(rig.haptics) == 2
    assert GateState.ACTIVE in gates[-100:]
    assert GateState.FAULT not in gates
    assert figures["faults"] == {}
    assert figures["limit_violations"] == 0


def test_a_device_is_taken_again_without_a_kick(make, monkeypatch, tmp_path):
    """The mouse has turned the tool; it goes on, and force sets in gently."""

    def watch(haptic, root):
        port = haptic.loop.device.GetOutputPort("F_Ho_W_rendered")
        asked = port.Eval(haptic.loop.device.GetMyContextFromRoot(root))
        shown = np.zeros(6)
        if haptic.backend is not None:
            shown = haptic.backend.read().F_Ho_B
        return [*find_tool(haptic, root)[4:], *asked[:3], *shown[:3]]

    file = tmp_path / "figures.json"
    with running(device_command(file, "--ttl-ms", 1000), file) as driver:
        monkeypatch.setattr(
            handle_holder,
            "open_device",
            lambda *_: UdpDevice("127.0.0.1", driver.port, ttl_s=1.0),
        )
        rig = make(
            {300: [MOUSE], 310: [TURN], 550: [RETAKE]},
            address="udp://there",
            watch=watch,
        )
        rig.run(1.15, pace=RealTimePacer(rig.period_s))
        rig.holder.close()
        driver.end()
    p_WT, asked, shown = np.split(np.array(rig.seen), [3, 6], axis=1)
    # The scene goes on, where it is.
    np.testing.assert_allclose(rig.page.times, 1e-3 * np.arange(1, 1151), atol=1e-9)
    assert np.linalg.norm(np.diff(p_WT, axis=0), axis=1).max() < 0.5e-3
    asked_Nm, shown_Nm = (np.linalg.norm(each[550:], axis=1) for each in (asked, shown))
    limit_Nm = rig.holder.site.max_torque_Nm
    # The handle is turned against the tool.
    assert asked_Nm[:10].max() > 0.5 * limit_Nm
    most = np.clip((np.arange(600) - 99) / 200, 0.0, 1.0) * limit_Nm
    assert (shown_Nm < most + 0.02 * limit_Nm).all()
    assert rig.holder.taken is not None and not rig.holder.taken.waits


def test_a_tool_that_begins_in_an_object_is_told_of_and_not_felt(
    scene, meshcat, monkeypatch
):
    """The handle is led out, and Restart puts the tool into it."""
    placed = dataclasses.replace(
        scene, device=dataclasses.replace(scene.device, base=Pose())
    )
    height_m = [PLATE_TOP + TOOL_HALF_HEIGHT - 0.008]
    device = ScriptedDevice(lambda k: make_reading(k, position=(0, 0, height_m[0])))
    monkeypatch.setattr(handle_holder, "open_device", lambda *_: device)

    def watch(haptic, root):
        if len(rig.seen) == 397:
            height_m[0] = 0.05
        return find_tool(haptic, root)[6]

    rig = CockpitRig(
        placed, meshcat, monkeypatch, {400: [{"do": "restart"}]},
        address="udp://there", watch=watch,
    )  # fmt: skip
    rig.run(0.8)
    first, last = rig.page.states[0], rig.page.states[-1]
    assert first["start"].startswith("The tool starts 8 mm deep in 'plate': lead")
    assert last["start"] == ""
    gates = [GATES[outlook.gate] for outlook in rig.page.outlooks]
    assert set(gates[:9]) == {"waiting"} and gates[-1] == "active"
    # From the plate it was pressed up, and nobody felt it.
    assert rig.seen[299] > rig.seen[0]
    assert not any(command.F_Ho_B.any() for command in device.commands[:400])
    assert rig.seen[400] == pytest.approx(0.05, abs=1e-6)


def test_gravity_of_the_page_is_that_of_a_scene_file(make, scene):
    """The same diagram comes of a switch as of a scene that names the effect."""
    rig = make({1: [{"do": "effect", "name": "gravity", "on": True}]})
    rig.run(0.4)
    effects = dataclasses.replace(scene.effects, gravity=GravityParameters())
    assert rig.last.scene == dataclasses.replace(scene, effects=effects)
