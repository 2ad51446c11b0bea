"""What the builder puts into a diagram, and how it is wired."""

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import EVERY, SYSTEMS, names, read_output, sources, unfed
from loop_by_hand import add_loop_by_hand
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource
from shapes import SHAPES
from twin_rig import X_WH, make_arm

from drake_haptics.common.errors import MeshError, SceneError
from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.haptic_loop import ConnectMovingObject
from drake_haptics.scene.schema import (
    ContactParameters,
    Effects,
    FrictionParameters,
    Material,
    Pose,
)
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.device.haptic_device import HapticDevice

START = (0.0, 0.0, 0.0, 0.05)


def test_a_scene_gets_the_systems_it_needs_and_no_more(tmp_path):
    haptic = BuildHapticDiagram(over_a_plate(tmp_path, [START]))
    assert names(haptic.diagram) == SYSTEMS
    assert haptic.visualizer is None
    assert haptic.period_s == 1e-3
    assert names(haptic.loop.device) == {"rendered_force_hold", "simulated_arm"}


def test_a_budget_of_ticks_adds_what_keeps_it_first_and_last(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.device.tick_budget_us = 500.0
    haptic = BuildHapticDiagram(scene, meshcat=Meshcat())
    assert names(haptic.diagram) == SYSTEMS | {
        "haptic_visualizer",
        "load_shedding",
        "tick_end",
    }
    systems = [system.get_name() for system in haptic.diagram.GetSystems()]
    assert (systems[0], systems[-1]) == ("load_shedding", "tick_end")
    context = haptic.diagram.CreateDefaultContext()
    for taker in ("contact_query", "contact_clustering", "haptic_visualizer"):
        system = haptic.diagram.GetSubsystemByName(taker)
        load_shedding = system.GetInputPort("load_shedding")
        assert load_shedding.Eval(system.GetMyContextFromRoot(context))[1] == 1.0


def test_a_meshcat_adds_the_visualizer(tmp_path):
    haptic = BuildHapticDiagram(over_a_plate(tmp_path, [START]), meshcat=Meshcat())
    assert names(haptic.diagram) == SYSTEMS | {"haptic_visualizer"}


def test_tool_and_handle_start_where_the_path_does(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.01, 0.02, 0.05)])
    scene.tool.grasp = Pose([0.0, 0.0, -0.03], [0.0, 0.0, 20.0])
    haptic = BuildHapticDiagram(scene)
    root = haptic.diagram.CreateDefaultContext()
    X_WT = vector_to_pose(read_output(haptic.loop.haptic_tool, "X_WT", root))
    np.testing.assert_allclose(X_WT.translation(), [0.01, 0.02, 0.06], atol=1e-15)
    X_WH = vector_to_pose(read_output(haptic.loop.device, "X_WH", root))
    assert (X_WH @ scene.tool.grasp.to_rigid_transform()).IsNearlyEqualTo(X_WT, 1e-8)
    # There the coupling is at ease, so a run starts without a jolt.
    display = read_output(haptic.loop.virtual_coupling, "F_Ho_W_commanded", root)
    np.testing.assert_allclose(display, 0.0, atol=1e-5)


def test_contact_reaches_the_tool_as_the_scene_says(tmp_path):
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 1e-3)])
    scene.contact = ContactParameters(
        tolerance_m=2e-3,
        stiffness_N_per_m=500.0,
        clustering="octree",
        cluster_size_m=0.1,
    )
    haptic = BuildHapticDiagram(scene)
    root = haptic.diagram.CreateDefaultContext()
    F = read_output(haptic.loop.penalty_force, "F_To_W", root)
    np.testing.assert_allclose(F, [0, 0, 0, 0, 0, 500.0 * 1e-3], atol=1e-9)


def test_progress_names_the_objects(tmp_path):
    calls = []
    BuildHapticDiagram(
        over_a_plate(tmp_path, [START]), progress=lambda *call: calls.append(call)
    )
    assert {name for name, _ in calls} == {"tool", "plate"}
    assert ("tool", 1.0) in calls


def test_a_missing_mesh_is_named(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.environment[0].mesh = str(tmp_path / "nothing.obj")
    with pytest.raises(MeshError, match=r"nothing\.obj"):
        BuildHapticDiagram(scene)


def test_an_unknown_preset_is_refused_before_any_mesh_is_read(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.tool.mesh = "nowhere.obj"
    scene.device.preset = "omega"
    with pytest.raises(SceneError, match="omega"):
        BuildHapticDiagram(scene)


CONSTRAINT = ContactParameters(law="constraint")


def add_loop_around_a_cart(tmp_path, builder=None, **options):
    """Returns a builder with a loop whose only object moves, and the loop."""
    haptic = BuildHapticDiagram(over_a_plate(tmp_path, [START]))
    builder = builder or DiagramBuilder()
    arm = make_arm()
    loop = add_loop_by_hand(
        builder,
        haptic,
        device=HapticDevice(arm, period_s=1e-3, max_force_N=1.0, max_torque_Nm=0.1),
        objects=[ContactObject("cart", haptic.tool.core)],
        X_WT=X_WH,
        **options,
    )
    return builder, loop


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"contact": ContactParameters(law="constrain")}, "contact.law is 'constrain'"),
        (
            {"materials": [Material(friction_coefficient=0.3)]},
            r"materials\[0\].friction_coefficient means nothing without",
        ),
        (
            {"contact": CONSTRAINT, "servo_period_s": 4e-4},
            r"1 / servo_period_s must be 1 / period_s \(1000\) times .*, is 2500",
        ),
        (
            {
                "contact": CONSTRAINT,
                "servo_period_s": 5e-4,
                "effects": Effects(friction=FrictionParameters()),
            },
            r"1 / servo_period_s is 2000, .* take effects\.friction out",
        ),
    ],
)
def test_what_would_be_left_out_in_silence_is_refused(tmp_path, options, words):
    with pytest.raises(SceneError, match=words):
        add_loop_around_a_cart(tmp_path, **options)


def test_a_second_loop_in_one_builder_is_refused_before_drake_ends_the_process(
    tmp_path,
):
    builder, _ = add_loop_around_a_cart(tmp_path)
    before = builder.GetSystems()
    with pytest.raises(ValueError, match=r"two systems called 'device', .* of its own"):
        add_loop_around_a_cart(tmp_path, builder)
    assert builder.GetSystems() == before


def test_a_loop_that_is_refused_leaves_the_builder_as_it_was(tmp_path):
    builder = DiagramBuilder()
    slow = ContactParameters(query_rate_hz=300.0)
    with pytest.raises(SceneError, match=r"1 / period_s \(1000\) divided by"):
        add_loop_around_a_cart(tmp_path, builder, contact=slow)
    assert not builder.GetSystems()
    add_loop_around_a_cart(tmp_path, builder)


@pytest.mark.parametrize("contact", [ContactParameters(), CONSTRAINT])
def test_materials_that_are_not_one_for_each_object_are_refused(tmp_path, contact):
    with pytest.raises(ValueError, match="must have one entry for each of the 1 obj"):
        add_loop_around_a_cart(tmp_path, contact=contact, materials=[])


def test_a_device_of_another_period_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"must be that of the loop, 0.002 s, is 0.00"):
        add_loop_around_a_cart(tmp_path, period_s=2e-3)


def test_a_motion_is_connected_once_before_drake_ends_the_process(tmp_path):
    builder, loop = add_loop_around_a_cart(tmp_path)
    pose = builder.AddSystem(ConstantVectorSource(np.zeros(7))).get_output_port()
    rest = builder.AddSystem(ConstantVectorSource(np.zeros(6))).get_output_port()
    ConnectMovingObject(builder, loop, "cart", pose, rest)
    with pytest.raises(ValueError, match="motion of 'cart' is connected already"):
        ConnectMovingObject(builder, loop, "cart", pose, rest)


@pytest.mark.parametrize("effects", [Effects(), Effects(**EVERY)])
def test_the_loop_can_be_put_into_a_diagram_of_ones_own(tmp_path, effects):
    builder, loop = add_loop_around_a_cart(tmp_path, effects=effects)
    pose = builder.AddNamedSystem(
        "pose", ConstantVectorSource(pose_to_vector(RigidTransform()))
    )
    rest = builder.AddNamedSystem("rest", ConstantVectorSource(np.zeros(6)))
    ConnectMovingObject(
        builder, loop, "cart", pose.get_output_port(), rest.get_output_port()
    )
    diagram = builder.Build()
    fed = sources(diagram)
    # An object moves, so that there is no chain.
    assert unfed(diagram) == {"device.coupled_motions"}
    assert {key for key, source in fed.items() if source == "pose.y0"} == {
        key for key in fed if key.endswith(".X_WO_cart")
    }


def test_an_object_that_does_not_move_cannot_be_moved(tmp_path):
    builder, loop = add_loop_around_a_cart(tmp_path)
    rest = builder.AddSystem(ConstantVectorSource(np.zeros(6)))
    with pytest.raises(ValueError, match="no object that moves is called 'plate'"):
        ConnectMovingObject(
            builder, loop, "plate", rest.get_output_port(), rest.get_output_port()
        )


def test_an_object_is_as_exact_as_its_scene_asks_for(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    torus = SHAPES["torus"]()
    path = tmp_path / "torus.npz"
    np.savez(path, V=torus.vertices, F=torus.triangles)
    scene.tool.mesh = str(path)
    scene.tool.max_triangles = 800
    scene.tool.decomposition = "merged"
    scene.tool.decomposition_error_m = 2e-3
    tool = BuildHapticDiagram(scene).tool
    assert len(tool.mesh.triangles) == 800
    assert 0 < tool.mesh.report.decimation_error_m < 1e-3
    assert tool.method == "merged" and 0 < tool.report.departure_m <= 2e-3


def test_a_round_shape_of_a_scene_keeps_its_chord_error(tmp_path):
    ball = tmp_path / "ball.sdf"
    ball.write_text(
        '<sdf version="1.9"><model name="ball"><link name="ball"><collision name="c">'
        "<geometry><sphere><radius>20</radius></sphere></geometry>"
        "</collision></link></model></sdf>"
    )
    scene = over_a_plate(tmp_path, [START])
    scene.tool.mesh, scene.tool.scale = str(ball), 1e-3
    for chord_error_m in (1e-3, 2e-5, None):
        scene.tool.chord_error_m = chord_error_m
        vertices = BuildHapticDiagram(scene).tool.mesh.vertices
        error = np.abs(np.linalg.norm(vertices, axis=1) - 0.02).max()
        expected = chord_error_m or 1e-4
        assert 0.2 * expected < error <= 1.001 * expected


def test_a_mesh_file_has_no_chord_error(tmp_path):
    scene = over_a_plate(tmp_path, [START])
    scene.environment[0].chord_error_m = 1e-4
    with pytest.raises(SceneError, match="chord_error_m is for models with round"):
        BuildHapticDiagram(scene)


@pytest.mark.parametrize(
    "group, key, value",
    [
        ("contact", "stiffness_N_per_m", -1.0),
        ("contact", "cluster_size_m", 1e-3),
        ("device", "rate_hz", 0.0),
    ],
)
def test_a_value_that_was_set_in_python_is_refused_by_its_key(
    tmp_path, group, key, value
):
    """As one in a file is; before any mesh is read."""
    scene = over_a_plate(tmp_path, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT)])
    setattr(getattr(scene, group), key, value)
    scene.tool.mesh = "not read.obj"
    with pytest.raises(SceneError, match=rf"^{group}\.{key} "):
        BuildHapticDiagram(scene)
