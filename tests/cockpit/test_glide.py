"""What a hand on a device feels does not step, whatever is asked on the page.

Each of these was a kick: a stiffness typed at once brought the force to the device's
limit in a tick, and a scene begun again with the handle in a wall shot the tool out.
"""

import dataclasses

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from cockpit_rig import FRICTION, CockpitRig
from fake_device import ScriptedDevice, make_reading

from drake_haptics.cockpit import handle_holder
from drake_haptics.scene.schema import Effects, PassivityParameters

ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.005)
DEEP_M, DOWN_TICKS, ASKED_AT = 6e-3, 100, 250
# Its base is put where the first readings say that the handle is.
PLACED_TICKS = 20
# Held still, the force would change by nothing; a tick of what is felt as a touch
# changes it by more.
LARGEST_STEP_N = 0.1
K_COUPLING, K_CONTACT = 800.0, 2e4
STIFF = {"do": "set", "key": "coupling.stiffness_N_per_m", "to": 3000}
SOFT = {**STIFF, "to": 100}
HARD = {"do": "set", "key": "contact.stiffness_N_per_m", "to": 1e5}
EARLY = {"do": "set", "key": "contact.tolerance_m", "to": 6e-3}
GRAVITY = {"do": "effect", "name": "gravity", "on": True}
OCTREE = {"do": "choose", "key": "contact.clustering", "to": "octree"}


def press_held(k):
    """A hand that cannot be moved: into the plate, and there for good."""
    depth_m = (0.005 + DEEP_M) * np.clip((k - PLACED_TICKS) / DOWN_TICKS, 0.0, 1.0)
    return make_reading(k, position=(0.0, 0.0, -depth_m))


def find_force(haptic, root):
    """The force (3,) that the device shows, N."""
    device = haptic.loop.device
    port = device.GetOutputPort("F_Ho_W_rendered")
    return port.Eval(device.GetMyContextFromRoot(root))[3:].copy()


def calc_force(K_coupling=K_COUPLING, K_contact=K_CONTACT, tolerance_m=2e-3):
    """Two springs in series, N: all corners of a face are one contact's stiffness."""
    return min((DEEP_M + tolerance_m) / (1 / K_coupling + 1 / K_contact), 8.5)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return over_a_plate(tmp_path_factory.mktemp("scene"), [ABOVE])


@pytest.mark.parametrize(
    ("asked", "effects", "force_N"),
    [
        ([STIFF], Effects(), calc_force(3000.0)),
        ([SOFT], Effects(), calc_force(100.0)),
        ([HARD], Effects(), calc_force(K_contact=1e5)),
        ([EARLY], Effects(), calc_force(tolerance_m=6e-3)),
        ([OCTREE], Effects(), calc_force()),
        ([STIFF, FRICTION], Effects(), calc_force(3000.0)),
        # Its reserve comes of the stiffness: another diagram.
        ([STIFF], Effects(passivity=PassivityParameters()), calc_force(3000.0)),
        ([{"do": "restart"}], Effects(), calc_force()),
        ([SOFT, {"do": "restart"}], Effects(), calc_force(100.0)),
        ([{"do": "handle", "to": "device"}], Effects(), calc_force()),
    ],
)
def test_the_force_on_a_device_does_not_step(
    scene, meshcat, monkeypatch, asked, effects, force_N
):
    monkeypatch.setattr(
        handle_holder, "open_device", lambda *_: ScriptedDevice(press_held)
    )
    rig = CockpitRig(
        dataclasses.replace(scene, effects=effects), meshcat, monkeypatch,
        {ASKED_AT: asked}, address="udp://there", watch=find_force,
    )  # fmt: skip
    # It presses before it would have shown that it is gentle.
    rig.holder.taken.resume()
    rig.run(0.8)
    shown = np.array(rig.seen)
    np.testing.assert_allclose(shown[ASKED_AT - 1], [0, 0, calc_force()], atol=0.02)
    steps = np.linalg.norm(np.diff(shown[ASKED_AT - 1 :], axis=0), axis=1)
    assert steps.max() < LARGEST_STEP_N
    np.testing.assert_allclose(shown[-1], [0, 0, force_N], atol=0.02)


def hold_still(k):
    """A hand that cannot be moved, in the air."""
    return make_reading(k)


def test_a_heavy_tool_is_not_dropped_into_a_hand(scene, meshcat, monkeypatch):
    """2 kg that fall pull at the coupling with twice what they weigh, in 40 ms."""
    device = ScriptedDevice(hold_still)
    monkeypatch.setattr(handle_holder, "open_device", lambda *_: device)
    heavy = dataclasses.replace(scene.tool, mass_kg=2.0)
    rig = CockpitRig(
        dataclasses.replace(scene, tool=heavy), meshcat, monkeypatch,
        {ASKED_AT: [GRAVITY]}, address="udp://there", watch=find_force,
    )  # fmt: skip
    rig.run(1.0)
    asked, felt = (
        np.linalg.norm(forces, axis=1)
        for forces in (rig.seen, [command.F_Ho_B[3:] for command in device.commands])
    )
    assert np.diff(asked).max() > 2 * LARGEST_STEP_N
    began = np.flatnonzero(felt)[0]
    steps = np.abs(np.diff(felt))
    assert steps[: began + 100].max() < LARGEST_STEP_N
    # Then the tool swings, as physics has it; the rise adds its share of each tick.
    swing = np.abs(np.diff(asked[began + 100 :])).max()
    assert steps.max() < swing + asked.max() / 200 < np.diff(asked).max()
    # In 0.2 s all of it is there, and before no more than its share of the time since
    # gravity was asked for.
    share = (np.arange(began, began + 200) - ASKED_AT) / 200
    assert (felt[began : began + 200] <= share * asked.max() + 1e-9).all()
    assert felt[-1] == pytest.approx(asked[-1], abs=LARGEST_STEP_N) and asked[-1] > 2.0


def test_back_to_the_file_glides_too(scene, meshcat, monkeypatch):
    monkeypatch.setattr(
        handle_holder, "open_device", lambda *_: ScriptedDevice(press_held)
    )
    rig = CockpitRig(
        scene, meshcat, monkeypatch,
        {ASKED_AT: [STIFF, FRICTION], 800: [{"do": "reset"}]},
        address="udp://there", watch=find_force,
    )  # fmt: skip
    rig.run(1.4)
    assert len(rig.haptics) == 3
    steps = np.linalg.norm(np.diff(rig.seen[ASKED_AT - 1 :], axis=0), axis=1)
    assert steps.max() < LARGEST_STEP_N
    np.testing.assert_allclose(rig.seen[799], [0, 0, calc_force(3000.0)], atol=0.02)
    np.testing.assert_allclose(rig.seen[-1], [0, 0, calc_force()], atol=0.02)


def test_a_scene_begun_again_in_the_simulated_hand_is_the_same(
    scene, meshcat, monkeypatch
):
    """With a value that was on its way when it began."""
    rig = CockpitRig(
        scene, meshcat, monkeypatch,
        {ASKED_AT: [{"do": "restart"}], 400: [STIFF], 450: [{"do": "restart"}]},
        watch=find_force,
    )  # fmt: skip
    rig.run(0.8)
    np.testing.assert_allclose(rig.seen[250:400], rig.seen[:150], atol=1e-12)
    coupling = rig.last.loop.virtual_coupling
    assert rig.last.scene.coupling.stiffness_N_per_m == 3000.0
    assert coupling is not rig.haptics[0].loop.virtual_coupling
