"""Which bodies of a plant are the tool and its environment."""

import numpy as np
import pytest
from plant_scenes import PlantScene
from pydrake.geometry import Box, CollisionFilterDeclaration, GeometrySet, Role, Sphere
from pydrake.math import RigidTransform
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    QuaternionFloatingJoint,
    RevoluteJoint,
    SpatialInertia,
)

from drake_haptics import ContactParameters, Material
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.geometry.parsing.body_shapes import find_body_geometries
from drake_haptics.rendering.bodies import (
    exclude_own_contact,
    find_body,
    find_environment,
    find_in_state,
    make_rendered_bodies,
)

BALL = Sphere(0.02)


@pytest.fixture
def scene():
    """A tool with a tip welded on, held by a hinge to an arm; a slab and a block."""
    scene = PlantScene()
    tool, tip, arm, _ = (scene.add(name, BALL) for name in ("tool", "tip", "arm", "b"))
    scene.add("empty")
    scene.add_slab()
    scene.plant.WeldFrames(tool.body_frame(), tip.body_frame())
    scene.plant.AddJoint(
        RevoluteJoint("hinge", arm.body_frame(), tool.body_frame(), [0, 1, 0])
    )
    return scene.finalize()


def names(bodies):
    return [body.name() for body in bodies]


def environment(scene, tool="tool", role=Role.kProximity):
    return find_environment(
        scene.plant,
        scene.scene_graph.model_inspector(),
        scene.plant.GetBodyByName(tool),
        role,
    )


def render(scene, tool, *bodies):
    return make_rendered_bodies(
        scene.plant,
        scene.scene_graph.model_inspector(),
        scene.plant.GetBodyByName(tool),
        [scene.plant.GetBodyByName(name) for name in bodies],
        role=Role.kProximity,
        chord_error_m=1e-3,
        progress=None,
    )


def test_a_body_is_found_by_itself_its_name_and_its_full_name(scene):
    tool = scene.plant.GetBodyByName("tool")
    full = tool.scoped_name().get_full()
    assert "::" in full
    for given in (tool, "tool", full):
        assert find_body(scene.plant, given, "tool_body") is tool


def test_a_body_that_is_not_there_is_answered_with_those_that_are(scene):
    with pytest.raises(ValueError, match=r"tool_body: no body is called 'tol'.*tool, "):
        find_body(scene.plant, "tol", "tool_body")


def test_a_body_of_another_plant_is_refused(scene):
    other = PlantScene().add("tool", BALL)
    with pytest.raises(ValueError, match="tool_body: body 'tool' is of another plant"):
        find_body(scene.plant, other, "tool_body")


def test_a_name_of_several_bodies_is_refused():
    scene = PlantScene()
    for model in ("left", "right"):
        instance = scene.plant.AddModelInstance(model)
        inertia = SpatialInertia.SolidSphereWithMass(1, 1)
        scene.plant.AddRigidBody("hand", instance, inertia)
    scene.finalize()
    with pytest.raises(ValueError, match=r"called 'hand': left::hand, right::hand"):
        find_body(scene.plant, "hand", "environment")
    found = find_body(scene.plant, "right::hand", "environment")
    assert found.model_instance() == scene.plant.GetModelInstanceByName("right")


@pytest.mark.parametrize(
    ("scoped", "expected"),
    [
        (["left::hand", "right::hand"], ["left_hand", "right_hand"]),
        (["m::box", "n::box", "k::m_box"], ["m::box", "n_box", "m_box"]),
        (["a_b::c", "a::b_c", "d::c", "d::b_c"], ["a_b::c", "a::b_c", "d_c", "d_b_c"]),
    ],
    ids=["by these alone", "clash with a body", "clash with each other"],
)
def test_equal_names_are_told_apart_by_their_models(scoped, expected):
    scene = PlantScene()
    scene.add("tool", BALL)
    for item in scoped:
        model, name = item.split("::")
        if not scene.plant.HasModelInstanceNamed(model):
            scene.plant.AddModelInstance(model)
        body = scene.plant.AddRigidBody(
            name,
            scene.plant.GetModelInstanceByName(model),
            SpatialInertia.SolidSphereWithMass(1, 1),
        )
        scene.touchable(body, BALL)
    scene.finalize()
    # Each body has a gap of its own to the tool, by which it is recognized.
    bodies = [find_body(scene.plant, item, "environment") for item in scoped]
    gaps_m = 1e-3 * np.arange(1, len(bodies) + 1)
    directions = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0]]
    for body, gap_m, along in zip(bodies, gaps_m, directions, strict=False):
        X_WB = RigidTransform((2 * BALL.radius() + gap_m) * np.array(along))
        scene.plant.SetDefaultFloatingBaseBodyPose(body, X_WB)
    rendering = scene.render(
        environment=bodies,
        contact=ContactParameters(tolerance_m=5e-3),
        materials={expected[0]: Material(stiffness_N_per_m=1.0)},
    )
    scene.start()
    context = rendering.GetMyContextFromRoot(scene.root)
    contacts = rendering.GetOutputPort("contacts").Eval(context)
    nearest_m = [
        min(contacts.distance[contacts.object_index == i]) for i in range(len(bodies))
    ]
    # Both balls are polytopes within a chord error of 0.1 mm.
    np.testing.assert_allclose(nearest_m, gaps_m, rtol=0, atol=2e-4)
    assert [item.name for item in rendering.objects] == expected


def test_the_environment_is_all_that_the_tool_can_meet(scene):
    # Neither what is welded to it, nor its neighbor on a joint, nor the shapeless.
    assert names(environment(scene)) == ["b", "slab"]
    assert names(environment(scene, "b")) == ["tool", "tip", "arm", "slab"]
    assert names(environment(scene, role=Role.kIllustration)) == []


def test_what_the_model_filters_out_is_not_met(scene):
    inspector = scene.scene_graph.model_inspector()
    tool, block = (
        GeometrySet(
            find_body_geometries(
                scene.plant, inspector, scene.plant.GetBodyByName(name)
            )
        )
        for name in ("tool", "b")
    )
    scene.scene_graph.collision_filter_manager().Apply(
        CollisionFilterDeclaration().ExcludeBetween(tool, block)
    )
    assert names(environment(scene)) == ["slab"]


def test_what_is_welded_to_the_world_is_posed_and_the_rest_is_not():
    scene = PlantScene()
    scene.add("tool", BALL)
    table = scene.add("table", BALL)
    cup = scene.add("cup", BALL)
    scene.add("cart", BALL)
    scene.touchable(scene.plant.world_body(), BALL)
    X_WT, X_TC = RigidTransform([0.1, 0.2, 0.3]), RigidTransform([0.0, 0.0, 0.5])
    scene.plant.WeldFrames(scene.plant.world_frame(), table.body_frame(), X_WT)
    scene.plant.WeldFrames(table.body_frame(), cup.body_frame(), X_TC)
    scene.finalize()
    tool, objects = render(scene, "tool", "table", "cup", "cart", "world")
    assert tool.X_WB is None
    poses = {item.name: item.X_WB for item in objects}
    assert poses["cart"] is None
    np.testing.assert_allclose(poses["table"].translation(), [0.1, 0.2, 0.3])
    np.testing.assert_allclose(poses["cup"].translation(), [0.1, 0.2, 0.8])
    np.testing.assert_allclose(poses["world"].translation(), np.zeros(3))


def test_what_cannot_be_is_refused_by_name(scene):
    with pytest.raises(ValueError, match="tool_body: 'slab' is welded to the world"):
        render(scene, "slab", "b")
    with pytest.raises(
        ValueError, match=r"no body that 'tool' can meet.* role proximity"
    ):
        render(scene, "tool")
    with pytest.raises(ValueError, match="'tip' is rigidly attached to the tool"):
        render(scene, "tool", "tip")
    with pytest.raises(ValueError, match="'tool' is rigidly attached to the tool"):
        render(scene, "tool", "tool")
    with pytest.raises(ValueError, match="environment: 'b' is named twice"):
        render(scene, "tool", "b", "b")
    with pytest.raises(ValueError, match="'empty' has no shape"):
        render(scene, "tool", "empty")


def test_only_the_tools_contact_with_the_environment_is_filtered(scene):
    plant, inspector = scene.plant, scene.scene_graph.model_inspector()
    tool, slab = plant.GetBodyByName("tool"), plant.GetBodyByName("slab")

    def filtered(a, b):
        (first,), (second,) = (
            find_body_geometries(plant, inspector, plant.GetBodyByName(name))
            for name in (a, b)
        )
        return inspector.CollisionFiltered(first, second)

    assert not filtered("tool", "slab")
    left = exclude_own_contact(plant, scene.scene_graph, tool, [slab])
    assert filtered("tool", "slab")
    assert not filtered("b", "slab")
    assert not filtered("tip", "slab")
    assert left == ["b"]


def test_a_tool_without_collision_shapes_has_nothing_to_filter():
    scene = PlantScene()
    tool, slab = scene.add("tool"), scene.add_slab()
    scene.plant.RegisterVisualGeometry(
        tool, RigidTransform(), Box(1, 1, 1), "look", np.ones(4)
    )
    scene.finalize()
    assert exclude_own_contact(scene.plant, scene.scene_graph, tool, [slab]) == []


def test_a_free_body_is_found_in_the_state(scene):
    """Truth: Drake's own kinematics at a random state, quaternions of any length."""
    x = np.random.default_rng(0).normal(size=scene.plant.num_multibody_states())
    scene.start()
    scene.plant.SetPositionsAndVelocities(scene.context, x)
    for name in ("arm", "b", "empty"):
        q, v = find_in_state(scene.plant.GetBodyByName(name))
        X_WB = vector_to_pose(x[q : q + 7])
        assert X_WB.IsNearlyEqualTo(scene.pose(name), 1e-14)
        np.testing.assert_allclose(x[v : v + 6], scene.velocity(name), rtol=1e-15)


@pytest.mark.parametrize("name", ["tool", "tip", "slab"])
def test_a_body_on_another_is_not_found_in_the_state(scene, name):
    assert find_in_state(scene.plant.GetBodyByName(name)) is None


def test_a_free_joint_off_the_bodys_origin_is_not_taken_for_its_pose():
    scene = PlantScene()
    tool = scene.add("tool", BALL)
    grip = scene.plant.AddFrame(
        FixedOffsetFrame("grip", tool.body_frame(), RigidTransform([0.1, 0, 0]))
    )
    scene.plant.AddJoint(
        QuaternionFloatingJoint("free", scene.plant.world_frame(), grip)
    )
    scene.finalize()
    assert find_in_state(tool) is None
