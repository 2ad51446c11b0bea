"""Each effect that a scene names is in its diagram, wired, and no other."""

import subprocess
import sys
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import EVERY, SYSTEMS, inputs, names, read_output, sources, unfed
from pydrake.geometry import Meshcat

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    Material,
    PassivityParameters,
)
from drake_haptics.simulation.run import run

OF_EFFECT = {
    "shading": "force_shading",
    "friction": "stick_slip_friction",
    "braking": "pre_contact_braking",
    "gravity": "tool_gravity",
    "passivity": "passivity_control",
}
# Each by itself, and each missing.
SUBSETS = [subset for n in (0, 1, 4, 5) for subset in combinations(sorted(EVERY), n)]
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
    # No port is left over either: the tool has one for each force, and two of the
    # contact chain, and all are fed. What the coupling feels is not what the device
    # shows where passivity control comes in between.
    forces = {"coupling", "contact"} | {"friction", "braking", "gravity"} & {*effects}
    chain = {"contact_chain", "motions_and_gains"}
    assert inputs(loop.haptic_tool) == forces | chain
    assert set(loop.wrench_sources) == forces
    fed = sources(haptic.diagram)
    for force in forces:
        assert fed[f"haptic_tool.{force}"] == SOURCE_OF_FORCE[force]
    shading, passivity = "shading" in effects, "passivity" in effects
    assert unfed(haptic.diagram) == ({"device.coupled_motions"} if passivity else set())
    if not passivity:
        joined = "virtual_coupling.motions_and_gains"
        assert fed["device.coupled_motions"] == joined
    assert fed["contact_clustering.contacts"] == (
        "force_shading.contacts" if shading else "contact_query.contacts"
    )
    assert fed["device.F_Ho_W_commanded"] == (
        "passivity_control.F_Ho_W_commanded"
        if passivity
        else "virtual_coupling.F_Ho_W_commanded"
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
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import *
scene = Scene(tool=Tool(mesh={scene.tool.mesh!r}),
              environment=[EnvironmentObject("plate", {scene.environment[0].mesh!r})],
              hand=HandParameters(path=HandPathParameters(waypoints=[Waypoint(position_m=[0,
              0, 0.05])])))
BuildHapticDiagram(scene)
print(*(n for n in {sorted(OF_EFFECT.values())}
        if any(m.endswith("." + n) for m in sys.modules)))
scene.effects.gravity = GravityParameters()
BuildHapticDiagram(scene)
print(*(n for n in {sorted(OF_EFFECT.values())}
        if any(m.endswith("." + n) for m in sys.modules)))
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines() == ["", "tool_gravity"]


def test_braking_looks_further_but_contact_does_not_push_there(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 3e-3)])
    scene.contact = ContactParameters(tolerance_m=2e-3)
    for distance, contacts in [(1e-3, 0), (4e-3, 1)]:
        scene.effects = Effects(braking=BrakingParameters(distance_m=distance))
        haptic = BuildHapticDiagram(scene)
        loop, root = haptic.loop, haptic.diagram.CreateDefaultContext()
        found = haptic.diagram.GetOutputPort("contacts").Eval(root)
        assert (len(found) > 0) == (contacts > 0)
        F = read_output(loop.penalty_force, "F_To_W", root)
        np.testing.assert_array_equal(F, np.zeros(6))


def build_on_two_plates(folder, contact, *materials):
    """Yields diagrams of a tool 1 mm over two plates at one place, the second of each.

    Half of the force comes from each plate.
    """
    scene = over_a_plate(folder, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 1e-3)])
    (plate,) = scene.environment
    scene.contact = contact
    for material in materials:
        second = replace(plate, name="second", material=material)
        scene.environment = [plate, second]
        yield BuildHapticDiagram(scene)


def test_each_object_pushes_with_its_own_stiffness(tmp_path):
    contact = ContactParameters(tolerance_m=2e-3, stiffness_N_per_m=500.0)
    materials = Material(), Material(stiffness_N_per_m=1500.0)
    pushes = []
    for haptic in build_on_two_plates(tmp_path, contact, *materials):
        root = haptic.diagram.CreateDefaultContext()
        pushes.append(read_output(haptic.loop.penalty_force, "F_To_W", root)[5])
    np.testing.assert_allclose(pushes[1], 2.0 * pushes[0], rtol=1e-9)


def test_each_object_damps_with_its_own_damping(tmp_path):
    # They share the damper: b₁/2 + b₂/2 of the speed of approach.
    contact = ContactParameters(tolerance_m=2e-3, damping_Ns_per_m=4.0)
    materials = Material(), Material(damping_Ns_per_m=20.0)
    damped = []
    for haptic in build_on_two_plates(tmp_path, contact, *materials):
        force = haptic.loop.penalty_force
        root = haptic.diagram.CreateDefaultContext()
        context = force.GetMyMutableContextFromRoot(root)
        pushes = []
        for speed in (0.0, 0.1):
            falling = [0.0, 0.0, 0.0, 0.0, 0.0, -speed]
            force.GetInputPort("V_WT").FixValue(context, falling)
            pushes.append(force.GetOutputPort("F_To_W").Eval(context)[5])
        damped.append(pushes[1] - pushes[0])
    assert damped[0] > 0.0
    np.testing.assert_allclose(damped[1], damped[0] * (4.0 + 20.0) / (4.0 + 4.0))


@pytest.mark.parametrize("own", [None, 0.6, 0.0])
def test_each_object_rubs_with_its_own_friction(tmp_path, own):
    # Pressed onto the plate and drawn 40 mm along it: in sliding the force across is μ
    # of the force along the normal.
    down = TOOL_HALF_HEIGHT - 5e-3
    path = [(0.0, 0.0, 0.0, down), (0.3, 0.0, 0.0, down), (0.8, 0.04, 0.0, down)]
    scene = over_a_plate(tmp_path, path)
    scene.effects = Effects(friction=FrictionParameters(coefficient=0.2))
    scene.environment[0].material = Material(friction_coefficient=own)
    haptic = BuildHapticDiagram(scene)
    friction = haptic.loop.effects.friction
    ratios = []

    def look(root):
        if root.get_time() > 0.6:
            across, along = (
                read_output(system, "wrench_model", root)[3:6]
                for system in (friction, haptic.loop.penalty_force)
            )
            ratios.append(np.linalg.norm(across) / along[2])

    run(haptic, 0.75, on_tick=look)
    assert np.mean(ratios) == pytest.approx(0.2 if own is None else own, rel=0.02)


def test_the_reserve_is_what_coupling_softest_contact_and_tool_can_give_back(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    second = replace(
        scene.environment[0], name="second", material=Material(stiffness_N_per_m=250.0)
    )
    scene.environment = [scene.environment[0], second]
    scene.contact = ContactParameters(stiffness_N_per_m=5e4)
    force, torque, mass = 8.5, 0.188, scene.tool.mass_kg
    springs = force**2 / 800.0 / 2 + torque**2 / 1.0 / 2 + force**2 / 250.0 / 2
    for gravity, lifted in [
        (None, 0.0),
        (GravityParameters(acceleration_m_per_s2=[0.0, 3.0, -4.0]), 0.5 * mass * 5.0),
    ]:
        scene.effects = Effects(gravity=gravity, passivity=PassivityParameters())
        # The hand moves the tool with 1 m/s at most.
        expected_J = springs + 0.5 * mass * 1.0**2 + lifted
        assert measure_reserve(BuildHapticDiagram(scene)) == pytest.approx(expected_J)


def measure_reserve(haptic):
    """Returns what is left of a balance after a hand has put a thousand joules in."""
    passivity = haptic.loop.effects.passivity
    context = passivity.CreateDefaultContext()
    X_WH, F = [1.0, 0, 0, 0, 0, 0, 0], [0.0, 0, 0, 0, 0, -1000.0]
    ports = [
        (passivity.GetInputPort("F_Ho_W_desired"), F),
        (passivity.GetInputPort("F_Ho_W_rendered"), F),
        (passivity.GetInputPort("V_WH"), np.zeros(6)),
    ]
    for port, value in ports:
        port.FixValue(context, value)
    for height in (0.0, 1.0, 2.0):
        X_WH[6] = height
        passivity.GetInputPort("X_WH").FixValue(context, X_WH)
        updated = passivity.EvalUniquePeriodicDiscreteUpdate(context)
        context.SetDiscreteState(updated.Clone())
    return passivity.GetOutputPort("energy_J").Eval(context)[0]
