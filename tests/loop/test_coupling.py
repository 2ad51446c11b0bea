"""The limits of a device become those of its coupling, wherever one is made."""

from dataclasses import replace

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from cube_scene import make_scene
from slider_device import PERIOD, Slider

from drake_haptics.loop.add_haptic_loop import make_coupling_gains
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.simulation.live_values import write_live_values
from drake_haptics.systems.device.haptic_device import HapticDevice

COUPLING = CouplingParameters(stiffness_N_per_m=500.0)


def make_device(max_force_N=3.0, max_torque_Nm=0.1):
    return HapticDevice(
        Slider(), period_s=PERIOD, max_force_N=max_force_N, max_torque_Nm=max_torque_Nm
    )


def limits(gains):
    return gains.max_force_N, gains.max_torque_Nm


def test_it_yields_at_the_limits_of_the_device_and_nowhere_without_one():
    gains = make_coupling_gains(COUPLING, make_device())
    assert gains.stiffness_N_per_m == 500.0
    assert limits(gains) == (3.0, 0.1)
    assert limits(make_coupling_gains(COUPLING, None)) == (np.inf, np.inf)


def test_without_torque_it_turns_with_what_the_force_has_at_a_hand_s_half_width():
    gains = make_coupling_gains(COUPLING, make_device(max_torque_Nm=0.0))
    assert limits(gains) == (3.0, pytest.approx(3.0 * 0.05))


def test_a_device_that_shows_no_force_does_not_limit_it():
    no_force = make_device(max_force_N=0.0, max_torque_Nm=0.0)
    assert limits(make_coupling_gains(COUPLING, no_force)) == (np.inf, np.inf)


def test_a_scene_s_coupling_keeps_them_while_its_values_change(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT)])
    scene = replace(scene, device=replace(scene.device, max_force_N=2.0))
    haptic = BuildHapticDiagram(scene)
    root = haptic.diagram.CreateDefaultContext()
    coupling = haptic.loop.virtual_coupling
    context = coupling.GetMyContextFromRoot(root)
    before = coupling.get_gains(context)
    assert limits(before) == (2.0, haptic.loop.device.max_torque_Nm)
    write_live_values(haptic, root, replace(scene, coupling=COUPLING))
    assert coupling.get_gains(context).stiffness_N_per_m == 500.0
    assert limits(coupling.get_gains(context)) == limits(before)


@pytest.mark.parametrize("has_device", [True, False])
def test_a_rendering_s_coupling_has_those_of_its_device(has_device):
    device = make_device() if has_device else None
    _, rendering = make_scene(coupling=COUPLING, device=device)
    coupling = rendering.GetSubsystemByName("virtual_coupling")
    gains = coupling.get_gains(coupling.CreateDefaultContext())
    assert limits(gains) == ((3.0, 0.1) if has_device else (np.inf, np.inf))
