"""Each effect that a scene names is in its diagram, wired, and no other."""

import subprocess
import sys
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import EVERY, SYSTEMS, names, sources
from pydrake.geometry import Meshcat

from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.scene import Braking, Contact, Effects, Material

OF_EFFECT = {
    "shading": "force_shading",
    "friction": "stick_slip_friction",
    "braking": "pre_contact_braking",
    "gravity": "tool_gravity",
    "passivity": "passivity_control",
}
SUBSETS = [
    subset for n in range(len(EVERY) + 1) for subset in combinations(sorted(EVERY), n)
]
START = (0.0, 0.0, 0.0, 0.05)
SOURCE_OF_FORCE = {
    "coupling": "virtual_coupling.wrench_model",
    "contact": "penalty_force.wrench_model",
    "friction": "stick_slip_friction.wrench_model",
    "braking": "pre_contact_braking.wrench_model",
    "gravity": "tool_gravity.wrench_model",
}


@pytest.mark.parametrize("effects", SUBSETS, ids="+".join)
def test_a_diagram_holds_exactly_the_systems_of_the_effects_named(tmp_path, effects):
    scene = over_a_plate(tmp_path, [START])
    scene.effects = Effects(**{name: EVERY[name] for name in effects})
    haptic = BuildHapticDiagram(scene)
    assert names(haptic.diagram) == SYSTEMS | {OF_EFFECT[name] for name in effects}
    loop = haptic.loop
    for name, system in vars(loop.effects).items():
        assert (system is not None) == (name in effects)
    # No port is left over either: the tool has one for each force, and all are fed.
    forces = {"coupling", "contact"} | {"friction", "braking", "gravity"} & {*effects}
    tool = loop.haptic_tool
    assert (
        {tool.get_input_port(i).get_name() for i in range(tool.num_input_ports())}
        == forces
        == set(loop.wrench_sources)
    )
    fed = sources(haptic.diagram)
    for system in haptic.diagram.GetSystems():
        for i in range(system.num_input_ports()):
            name = f"{system.get_name()}.{system.get_input_port(i).get_name()}"
            assert name in fed, name
    for force in forces:
        assert fed[f"haptic_tool.{force}"] == SOURCE_OF_FORCE[force]
    shading, passivity = "shading" in effects, "passivity" in effects
    assert fed["contact_clustering.contacts"] == (
        "force_shading.contacts" if shading else "contact_query.contacts"
    )
    assert fed["device.F_display"] == (
        "passivity_control.F_display" if passivity else "virtual_coupling.F_display"
    )


@pytest.mark.parametrize("effects", [Effects(), Effects(friction=EVERY["friction"])])
def test_friction_is_shown_where_there_is_some(tmp_path, effects):
    scene = over_a_plate(tmp_path, [START])
    scene.effects = effects
    fed = sources(BuildHapticDiagram(scene, meshcat=Meshcat()).diagram)
    expected = "stick_slip_friction.friction_force" if effects.friction else None
    assert fed.get("haptic_visualizer.friction_force") == expected


def test_what_a_scene_does_not_name_is_not_even_loaded(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    program = f"""
import sys
from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.scene import *
scene = Scene(tool=Tool(mesh={scene.tool.mesh!r}),
              environment=[EnvironmentObject("plate", {scene.environment[0].mesh!r})],
              hand=Hand(path=HandPath(waypoints=[Waypoint(position_m=[0, 0, 0.05])])))
BuildHapticDiagram(scene)
print(*(n for n in {sorted(OF_EFFECT.values())} if "drake_haptics.systems." + n
        in sys.modules))
scene.effects.gravity = Gravity()
BuildHapticDiagram(scene)
print(*(n for n in {sorted(OF_EFFECT.values())} if "drake_haptics.systems." + n
        in sys.modules))
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines() == ["", "tool_gravity"]


def test_braking_looks_further_but_contact_does_not_push_there(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 3e-3)])
    scene.contact = Contact(tolerance_m=2e-3)
    for distance, contacts in [(1e-3, 0), (4e-3, 1)]:
        scene.effects = Effects(braking=Braking(distance_m=distance))
        haptic = BuildHapticDiagram(scene)
        loop, root = haptic.loop, haptic.diagram.CreateDefaultContext()

        def value(port, root=root):
            return port.Eval(port.get_system().GetMyContextFromRoot(root))

        assert (len(value(loop.contacts)) > 0) == (contacts > 0)
        F = value(loop.penalty_force.get_tool_wrench_output_port())
        np.testing.assert_array_equal(F, np.zeros(6))


def test_each_object_pushes_with_its_own_stiffness(tmp_path):
    # Two plates at one place: half of the force comes from each.
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 1e-3)])
    second = replace(scene.environment[0], name="second")
    scene.contact = Contact(tolerance_m=2e-3, stiffness_N_per_m=500.0)
    pushes = []
    for material in (Material(), Material(stiffness_N_per_m=1500.0)):
        scene.environment = [scene.environment[0], replace(second, material=material)]
        haptic = BuildHapticDiagram(scene)
        root = haptic.diagram.CreateDefaultContext()
        force = haptic.loop.penalty_force
        F = force.get_tool_wrench_output_port().Eval(force.GetMyContextFromRoot(root))
        pushes.append(F[5])
    np.testing.assert_allclose(pushes[1], 2.0 * pushes[0], rtol=1e-9)
