"""A stylus that turns freely does not pry its tool through walls.

A cube between two thin walls, and a hand that turns the stylus until the cube would
stand across: a device of three axes shows no torque, but its coupling turns the tool
with a limited one, in every loop that is built for it.
"""

import numpy as np
import pytest
import trimesh
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate, write
from fake_device import ScriptedDevice, make_reading
from loop_by_hand import add_loop_by_hand
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.device_placement import make_device_port
from drake_haptics.scene.device_preset import list_device_presets, load_device_preset
from drake_haptics.scene.schema import EnvironmentObject, Pose

PERIOD_S = 1e-3
TURN_RAD, TURNED_IN, END_S = np.pi / 4, 200, 0.4
WALL_M, GAP_M = 4e-3, 1e-3
HALF_HAND_M = 0.05
PRESETS = {name: load_device_preset(name) for name in list_device_presets()}
THREE_AXES = [name for name, preset in PRESETS.items() if preset.actuated_axes == 3]


def turn(call):
    """A stylus at the origin that a hand turns about x, and holds."""
    half = 0.5 * TURN_RAD * min(1.0, call / TURNED_IN)
    return make_reading(call, wxyz=(np.cos(half), np.sin(half), 0.0, 0.0))


def make_slot(folder, preset):
    """Returns a scene of a cube with a gap of 0.5 mm to a wall on either side."""
    scene = over_a_plate(folder, [(0.0, 0.0, 0.0, 0.0)])
    wall = write(folder, "wall", trimesh.creation.box([0.06, WALL_M, 0.06]))
    y = TOOL_HALF_HEIGHT + 0.5 * GAP_M + 0.5 * WALL_M
    scene.environment = [
        EnvironmentObject(name=name, mesh=wall, pose=Pose(position_m=[0.0, side, 0.0]))
        for name, side in (("left", y), ("right", -y))
    ]
    scene.device.preset = preset
    scene.device.base = Pose()
    # So stiff that without a limit it would turn the cube with 7.9 N·m.
    scene.coupling.rotational_stiffness_Nm_per_rad = 10.0
    scene.coupling.rotational_damping_Nms_per_rad = 0.02
    return scene


def build_scene(scene):
    haptic = BuildHapticDiagram(scene, device=ScriptedDevice(turn))
    return haptic.diagram, haptic.loop


def add_loop(scene):
    """Builds the same by hand."""
    built = BuildHapticDiagram(scene, device=ScriptedDevice(turn))
    preset = PRESETS[scene.device.preset]
    device, X_WH = make_device_port(
        ScriptedDevice(turn),
        period_s=PERIOD_S,
        max_force_N=preset.max_force_N,
        max_torque_Nm=preset.max_torque_Nm,
    )
    builder = DiagramBuilder()
    loop = add_loop_by_hand(builder, built, device=device, X_WT=X_WH)
    return builder.Build(), loop


def pry(diagram, loop):
    """Returns the largest torque on the tool, N·m, and the least distance, m."""
    torques, distances = [], [0.0]
    coupling = loop.virtual_coupling.GetOutputPort("wrench_model")
    found = loop.found_contacts

    def look(root):
        F = coupling.Eval(loop.virtual_coupling.GetMyContextFromRoot(root))[:6]
        torques.append(np.linalg.norm(F[:3]))
        context = found.get_system().GetMyContextFromRoot(root)
        distances.extend(found.Eval(context).distance)

    simulator = Simulator(diagram)
    simulator.set_monitor(look)
    simulator.AdvanceTo(END_S)
    return max(torques), min(distances)


def test_there_are_devices_of_three_axes():
    assert set(THREE_AXES) == {"touch", "omni", "phantom_desktop", "omega_6", "falcon"}


@pytest.mark.filterwarnings("ignore::drake_haptics.scene.validation.SceneWarning")
@pytest.mark.parametrize(
    ("preset", "make"),
    [*((preset, build_scene) for preset in THREE_AXES), ("omega_6", add_loop)],
)
def test_a_cube_is_not_pried_into_the_walls_of_a_slot(tmp_path, preset, make):
    torque_Nm, distance_m = pry(*make(make_slot(tmp_path, preset)))
    lever_Nm = HALF_HAND_M * PRESETS[preset].max_force_N
    assert torque_Nm == pytest.approx(lever_Nm, rel=1e-9)
    # One edge at each wall bears it, more than half a side from the axis: less than
    # what its contact holds, 20 kN/m from 2 mm before the surface.
    assert lever_Nm / (2 * TOOL_HALF_HEIGHT) < 40.0
    assert distance_m >= 0.0
