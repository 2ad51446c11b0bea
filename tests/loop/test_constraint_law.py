"""Loops by the constraint law: what is in them, what is felt, and what is refused."""

import dataclasses
import math

import numpy as np
import pytest
import trimesh
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, TOOL_MASS, over_a_plate, write
from diagram_parts import names, read_output
from fake_device import ScriptedDevice
from loop_by_hand import add_loop_by_hand
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource
from slider_device import make_device

from drake_haptics import (
    BuildHapticDiagram,
    SceneError,
    find_scene,
    list_scenes,
    live_keys,
    load_scene,
    make_log_header,
    read_tick_log,
    run,
)
from drake_haptics.analysis.scene_stability import analyze_scene
from drake_haptics.authoring.plausibility import check_plausibility
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.device.backend import DeviceReading
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.loop.haptic_loop import ConnectMovingObject
from drake_haptics.scene.contact_law import calc_first_touch
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
)
from drake_haptics.scene.settings import change_scene
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.live_values import write_live_values
from drake_haptics.simulation.replay_log import replay
from drake_haptics.simulation.run import make_simulator
from drake_haptics.simulation.transfer_state import transfer_context
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.device.replayed_handle import ReplayedHandle
from drake_haptics.tick_log.log_diff import compare_logs
from drake_haptics.tick_log.tick_recorder import TickRecorder

SKIN = 3e-4
ABOVE, PRESS = TOOL_HALF_HEIGHT + 5e-3, TOOL_HALF_HEIGHT - 5e-3
WITHOUT_SPRINGS = ("effects.shading=", "effects.braking=")


def by_constraint(name):
    """A shipped scene under the constraint law, without what it does not have."""
    scene = load_scene(find_scene(name))
    extra = WITHOUT_SPRINGS if name == "rubbed_sphere" else ()
    return change_scene(scene, ["contact.law=constraint", *extra])


@pytest.fixture
def pressed(tmp_path):
    """A cube that comes down on a plate and is held there."""
    path = [(0.0, 0.0, 0.0, ABOVE), (0.15, 0.0, 0.0, PRESS)]
    scene = over_a_plate(tmp_path, path)
    scene.contact.law = "constraint"
    return scene


def advance(haptic, time_s, context=None):
    simulator = make_simulator(haptic, context)
    if context is None:
        simulator.Initialize()
    simulator.AdvanceTo(time_s)
    return simulator.get_mutable_context()


def read(haptic, context, name):
    return haptic.diagram.GetOutputPort(name).Eval(context)


@pytest.mark.parametrize("name", list_scenes())
def test_every_shipped_scene_runs_and_nothing_touches(name):
    haptic = BuildHapticDiagram(by_constraint(name))
    statistics = run(haptic, 1.0, energy=True)
    skin_m = calc_first_touch(haptic.scene.contact)
    assert statistics.contacts.max > 0
    assert statistics.max_force_N > 0.05
    # The step is linear: what a turn takes of the skin is of second order.
    assert statistics.least_distance_m == pytest.approx(skin_m, rel=0.1)
    energy = statistics.energy_J
    assert energy["contact"]["beyond"] < 5e-5
    assert energy["device"]["beyond"] < 5e-5


def test_the_systems_of_the_penalty_law_are_not_there(pressed):
    haptic = BuildHapticDiagram(pressed)
    assert names(haptic.diagram) == {"device", "constraint_tool_step"}
    loop = haptic.loop
    assert loop.haptic_tool is loop.virtual_coupling
    for name in ("contact_query", "contact_clustering", "penalty_force"):
        with pytest.raises(SceneError, match=r"contact\.law .* take penalty"):
            getattr(loop, name)


def test_the_force_is_the_couplings_at_the_rest_on_the_skin(pressed):
    haptic = BuildHapticDiagram(pressed)
    context = advance(haptic, 1.5)
    X_WT, X_WH = read(haptic, context, "X_WT"), read(haptic, context, "X_WH")
    height = PLATE_TOP + TOOL_HALF_HEIGHT + SKIN
    assert X_WT[6] == pytest.approx(height, abs=1e-7)
    F = read(haptic, context, "F_Ho_W_commanded")
    stretch = X_WT[6] - X_WH[6]
    assert F[5] == pytest.approx(
        haptic.scene.coupling.stiffness_N_per_m * stretch, 1e-3
    )
    assert F[5] > 0.5
    np.testing.assert_allclose(
        read(haptic, context, "F_To_W"), F, atol=1e-3 * np.linalg.norm(F)
    )
    wrench = read(haptic, context, "contact_wrench")
    assert len(read(haptic, context, "clusters")) == len(wrench.lambda_N)


def hold(name, until_s, held_s):
    """The force on a hand that stops where a scene's path is, (n, 3) N, at the end."""
    scene = load_scene(find_scene(name))
    waypoints = [w for w in scene.hand.path.waypoints if w.time_s <= until_s]
    path = dataclasses.replace(scene.hand.path, periodic=False, waypoints=waypoints)
    scene = dataclasses.replace(scene, hand=dataclasses.replace(scene.hand, path=path))
    haptic = BuildHapticDiagram(scene)
    forces = []

    def note(context):
        forces.append(read(haptic, context, "F_Ho_W_commanded")[3:].copy())

    run(haptic, until_s + held_s, on_tick=note)
    return haptic, np.array(forces)


@pytest.mark.parametrize("until_s", [0.8, 1.6])
def test_a_hand_held_still_feels_no_tremor(until_s):
    # Askew at the mouth of the hole, and on its floor.
    _, forces = hold("peg_in_hole", until_s, 1.0)
    at_rest = forces[-400:]
    assert np.linalg.norm(at_rest.mean(axis=0)) > 0.3
    assert calc_tremor(at_rest) < 5e-3
    # A tremor of 10 mN at 125 Hz would be found.
    at_rest[:, 0] += 0.01 * np.sqrt(2.0) * np.sin(2 * np.pi * 0.125 * np.arange(400))
    assert calc_tremor(at_rest) == pytest.approx(0.01, rel=0.5)


def calc_tremor(forces):
    """The rms, N, of what of forces (n, 3), N, is between 80 and 400 Hz."""
    spectrum = np.fft.rfft(forces - forces.mean(axis=0), axis=0) / len(forces)
    hertz = np.fft.rfftfreq(len(forces), 1e-3)
    felt = spectrum[(80.0 <= hertz) & (hertz <= 400.0)]
    return np.sqrt(2.0 * (np.abs(felt) ** 2).sum())


def test_the_peg_goes_in_and_comes_out_under_this_law_alone():
    def lowest_and_last(law):
        scene = load_scene(find_scene("peg_in_hole"))
        haptic = BuildHapticDiagram(change_scene(scene, [f"contact.law={law}"]))
        heights = []
        run(
            haptic,
            3.9,
            on_tick=lambda context: heights.append(read(haptic, context, "X_WT")[6]),
        )
        return min(heights), heights[-1]

    skin_m = load_scene(find_scene("peg_in_hole")).contact.skin_m
    lowest, last = lowest_and_last("constraint")
    # On the floor, and above the socket again.
    assert lowest == pytest.approx(0.005 + skin_m, abs=1e-5)
    assert last > 0.040
    # Springs that begin 2 mm before surfaces touch keep it out.
    assert lowest_and_last("penalty")[0] > 0.025


@pytest.mark.parametrize("thickness", [5e-5, 3e-3])
@pytest.mark.parametrize("speed", [0.5, 3.0])
def test_a_fast_hand_gets_through_no_wall(tmp_path, speed, thickness):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, 0.05)])
    wall = trimesh.creation.box([0.2, 0.2, thickness])
    scene.environment[0].mesh = write(tmp_path, "wall", wall)
    scene.contact.law = "constraint"
    # The handle goes on below the wall, and stays there.
    height = np.maximum(0.05 - speed * 1e-3 * np.arange(400), -0.05)
    X_WH = np.zeros((400, 7))
    X_WH[:, 0], X_WH[:, 6] = 1.0, height
    V_WH = np.zeros((400, 6))
    V_WH[height > -0.05, 5] = -speed
    device = HapticDevice(
        ReplayedHandle(X_WH, V_WH, 1e-3),
        period_s=1e-3,
        max_force_N=8.5,
        max_torque_Nm=0.188,
    )
    haptic = BuildHapticDiagram(scene, device=device)
    heights = []
    simulator = make_simulator(haptic)
    tool = haptic.loop.haptic_tool.GetMyMutableContextFromRoot(
        simulator.get_mutable_context()
    )
    tool.SetDiscreteState(np.array([*X_WH[0], *np.zeros(6)]))
    simulator.set_monitor(
        lambda context: heights.append(read(haptic, context, "X_WT")[6])
    )
    simulator.AdvanceTo(0.399)
    top = thickness / 2 + TOOL_HALF_HEIGHT
    assert min(heights) > top
    assert heights[-1] == pytest.approx(top + SKIN, abs=1e-6)
    # It is pressed with all that the device shows.
    assert read(haptic, simulator.get_context(), "F_To_W")[5] == pytest.approx(
        8.5, rel=1e-3
    )


def record(path, scene):
    with TickRecorder(path, make_log_header(scene)) as recorder:
        run(BuildHapticDiagram(scene, recorder=recorder), 1.2)
    return read_tick_log(path)


def test_two_runs_and_a_replay_are_the_same_to_the_last_bit(tmp_path):
    scene = load_scene(find_scene("peg_in_hole"))
    log = record(tmp_path / "a", scene)
    assert log.rows["contacts"].max() > 3
    np.testing.assert_array_equal(log.rows["contacts"], log.rows["clusters"])
    assert compare_logs(log, record(tmp_path / "b", scene)).is_bit_equal
    assert compare_logs(log, replay(log)).is_bit_equal
    # The comparison can fail.
    other = change_scene(scene, ["contact.skin_m=7e-5"])
    assert not compare_logs(log, replay(log, other)).is_bit_equal


def test_the_tool_weighs_and_passivity_control_finds_a_reserve(pressed):
    pressed.hand.path.waypoints = pressed.hand.path.waypoints[:1]
    pressed.effects.gravity = GravityParameters()
    changed = change_scene(pressed, ["effects.passivity={}"])
    haptic = BuildHapticDiagram(changed)
    context = advance(haptic, 1.0)
    F = read(haptic, context, "F_Ho_W_commanded")
    assert F[5] == pytest.approx(-9.81 * TOOL_MASS, rel=1e-3)
    assert math.isfinite(read(haptic, context, "energy_J")[0])


def test_friction_is_felt_drawn_and_booked(pressed):
    """The hand draws the cube along a plate: it feels μ N, and no energy is made."""
    pressed.hand.path.waypoints[1].time_s = 0.3
    last = dataclasses.replace(pressed.hand.path.waypoints[1], time_s=0.8)
    last.position_m = [0.02, 0.0, PRESS]
    pressed.hand.path.waypoints.append(last)
    pressed.effects.friction = FrictionParameters(coefficient=0.4)
    meshcat = Meshcat(MeshcatParams(host="localhost"))
    haptic = BuildHapticDiagram(pressed, meshcat=meshcat)
    haptic.visualizer.StartRecording()
    seen = []

    def note(context):
        seen.append(
            [
                read(haptic, context, "friction_force"),
                read(haptic, context, "contact_wrench").lambda_N,
            ]
        )

    books = run(haptic, 0.6, energy=True, on_tick=note).energy_J
    friction, N = seen[-1]
    assert friction.sliding.all() and len(friction.sliding) == len(N) >= 3
    np.testing.assert_allclose(
        friction.f_cluster_W.sum(axis=0), [-0.4 * N.sum(), 0.0, 0.0], atol=1e-3
    )
    assert meshcat.HasPath("/haptics/friction")
    assert books["friction"]["lost"] > 1e-3
    assert books["friction"]["beyond"] < 5e-5
    assert books["contact"]["beyond"] < 5e-5


def test_gains_of_the_coupling_change_as_it_runs(pressed):
    haptic = BuildHapticDiagram(pressed)
    assert {item.group for item in live_keys(pressed)} == {"coupling"}
    context = advance(haptic, 1.0)
    before = read(haptic, context, "F_Ho_W_commanded")[5]
    stiffer = change_scene(pressed, ["coupling.stiffness_N_per_m=1000"])
    write_live_values(haptic, context, stiffer)
    after = read(haptic, context, "F_Ho_W_commanded")[5]
    assert after / before == pytest.approx(1000.0 / 800.0, rel=1e-3)
    thicker = change_scene(pressed, ["contact.skin_m=4e-4"])
    with pytest.raises(ValueError, match="more than its live keys"):
        write_live_values(haptic, context, thicker)


@pytest.mark.parametrize("first", ["penalty", "constraint"])
def test_a_run_goes_on_under_the_other_law(pressed, first):
    second = {"penalty": "constraint", "constraint": "penalty"}[first]
    # As far apart as springs that hardly push leave them.
    settings = ["contact.tolerance_m=1e-3", "contact.stiffness_N_per_m=1e5"]
    old, new = (
        BuildHapticDiagram(change_scene(pressed, [f"contact.law={law}", *settings]))
        for law in (first, second)
    )
    context = advance(old, 1.0)
    went_on = transfer_context(old, context, new)
    np.testing.assert_array_equal(
        read(new, went_on, "X_WT"), read(old, context, "X_WT")
    )
    went_on = advance(new, 1.5, went_on)
    assert read(new, went_on, "F_Ho_W_commanded")[5] > 0.5


def test_a_loop_of_your_own_refuses_what_a_scene_does(pressed):
    haptic = BuildHapticDiagram(pressed)
    effects = Effects(braking=BrakingParameters())
    with pytest.raises(SceneError, match=r"effects\.braking does nothing"):
        add_loop_by_hand(
            DiagramBuilder(), haptic, device=make_device(), effects=effects
        )


def test_an_object_that_moves_gets_the_reaction(pressed):
    haptic = BuildHapticDiagram(pressed)
    builder = DiagramBuilder()
    rest = RigidTransform([0.0, 0.0, TOOL_HALF_HEIGHT])
    # The slider's handle begins 5 mm below the place where the tool rests.
    plate = RigidTransform([0.0, 0.0, 5e-3 - PLATE_TOP])
    loop = add_loop_by_hand(
        builder,
        haptic,
        device=make_device(),
        objects=[ContactObject("plate", haptic.environment[0].core)],
        X_HT=rest,
        X_WT=RigidTransform([0.0, 0.0, TOOL_HALF_HEIGHT + 5e-3 + SKIN]),
    )
    X_WO = builder.AddSystem(ConstantVectorSource(pose_to_vector(plate)))
    V_WO = builder.AddSystem(ConstantVectorSource(np.zeros(6)))
    ConnectMovingObject(
        builder, loop, "plate", X_WO.get_output_port(), V_WO.get_output_port()
    )
    with pytest.raises(ValueError, match="no object that moves"):
        ConnectMovingObject(
            builder, loop, "lid", X_WO.get_output_port(), V_WO.get_output_port()
        )
    diagram = builder.Build()
    root = diagram.CreateDefaultContext()
    F_T = read_output(loop.haptic_tool, "F_To_W", root)
    F_O = read_output(loop.haptic_tool, "F_O_W", root)
    assert F_T[5] > 0.5
    np.testing.assert_allclose(F_O[3:], -F_T[3:], atol=1e-9)


def test_a_servo_is_told_what_the_handle_feels_between_ticks(pressed):
    # A device that goes down from where the hand begins, and stays 2 mm too deep.
    site = find_device_site(pressed)
    down_B = site.X_WB.rotation().inverse() @ np.array([0.0, 0.0, -1.0])
    deepest_m = ABOVE - TOOL_HALF_HEIGHT - SKIN + 2e-3

    def read_handle(k):
        X_BH = pose_to_vector(site.X_BH)
        X_BH[4:] += min(5e-5 * k, deepest_m) * down_B
        return DeviceReading(k, 1e-3 * k, X_BH, np.zeros(6), np.zeros(6))

    haptic = BuildHapticDiagram(pressed, device=ScriptedDevice(read_handle))
    context = advance(haptic, 0.5)
    assert read(haptic, context, "F_Ho_W_commanded")[5] > 1.0
    model = haptic.diagram.GetSubsystemByName("handle_model")
    slopes = read_output(model, "handle_slopes", context)
    K = slopes[:36].reshape(6, 6)
    # In series with what does not give way; along the plate the tool follows.
    np.testing.assert_allclose(K[5, 5], pressed.coupling.stiffness_N_per_m, rtol=1e-3)
    assert abs(K[3, 3]) < 1.0 and abs(K[4, 4]) < 1.0


def test_it_is_drawn(pressed):
    meshcat = Meshcat(MeshcatParams(host="localhost"))
    haptic = BuildHapticDiagram(pressed, meshcat=meshcat)
    haptic.visualizer.StartRecording()
    context = advance(haptic, 0.6)
    haptic.visualizer.StopRecording()
    assert len(read(haptic, context, "contacts"))
    for path in ("contacts", "clusters", "force"):
        assert meshcat.HasPath(f"/haptics/{path}")


def test_plausibility_is_asked_as_ever(pressed):
    assert check_plausibility(BuildHapticDiagram(pressed)) == []
    pressed.hand.path.waypoints[0].position_m[2] = PLATE_TOP
    (sentence,) = check_plausibility(BuildHapticDiagram(pressed))
    assert "the tool starts" in sentence


def test_a_start_in_a_shape_is_told_and_led_out(pressed):
    pressed.hand.path.waypoints = pressed.hand.path.waypoints[:1]
    start = pressed.hand.path.waypoints[0].position_m
    start[2] = PLATE_TOP + TOOL_HALF_HEIGHT - 1e-3
    haptic = BuildHapticDiagram(pressed)
    with pytest.warns(SceneWarning, match="began in a shape"):
        statistics = run(haptic, 0.5)
    assert statistics.max_penetration_m == pytest.approx(1e-3, rel=0.05)
    assert statistics.max_force_N < 3.0


def test_stability_with_friction_is_refused_by_name(pressed):
    pressed.effects.friction = FrictionParameters()
    with pytest.raises(ValueError, match=r"no derivatives.*effects\.friction"):
        analyze_scene(pressed, map_size=0)
