"""Haptic rendering in plants: what bodies do, against what mechanics says."""

import warnings

import numpy as np
import pytest
import trimesh
from plant_scenes import PLANTS, G, PlantScene, make_push, over_a_slab
from pydrake.geometry import Box, Cylinder, Mesh, Role, SceneGraph, Sphere
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.framework import DiagramBuilder

from drake_haptics import AddHapticRendering
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    FrictionParameters,
    Material,
    ShadingParameters,
)
from drake_haptics.scene.validation import SceneWarning

K, MASS, HALF = 1e3, 0.1, 0.02
SOFT = ContactParameters(stiffness_N_per_m=K, damping_Ns_per_m=3.0)
CUBE = Box(2 * HALF, 2 * HALF, 2 * HALF)
# Where a cube of this mass rests, its middle.
REST = HALF + SOFT.tolerance_m - MASS * G / K


def render(scene, tool="tool", **options):
    return scene.render(tool, **{"contact": SOFT, **options})


def make_scene(config=PLANTS["sampled"], shape=CUBE, **options):
    """Returns a finalized scene of one body above a slab, and its rendering."""
    scene = over_a_slab(shape, config=config)
    return scene, render(scene, **options)


@pytest.mark.parametrize("config", PLANTS.values(), ids=PLANTS)
@pytest.mark.parametrize("shape", [CUBE, Sphere(HALF)], ids=["cube", "ball"])
def test_a_body_comes_to_rest_where_its_weight_is_borne(config, shape):
    scene, rendering = make_scene(config, shape, chord_error_m=2e-5)
    scene.start(tool=RigidTransform([0.1, 0.2, REST + 2e-4]))
    scene.simulator.AdvanceTo(1.5)
    p = scene.pose("tool").translation()
    chord = 2e-5 if isinstance(shape, Sphere) else 0.0
    assert p[2] == pytest.approx(REST, abs=chord + 1e-6)
    F = scene.read(rendering, "F_To_W")
    np.testing.assert_allclose(F[3:], [0, 0, MASS * G], atol=2e-3)


@pytest.mark.parametrize("config", PLANTS.values(), ids=PLANTS)
def test_there_is_no_sample_of_delay(config):
    """The force is that of the state now, also before the first step."""
    scene, rendering = make_scene(config)
    scene.start(tool=RigidTransform([0, 0, REST - 1e-4]))
    F = scene.read(rendering, "F_To_W")
    assert F[5] == pytest.approx(MASS * G + 1e-4 * K, rel=1e-9)
    (force,) = scene.read(rendering, "applied_spatial_force")
    np.testing.assert_array_equal(force.F_Bq_W.get_coeffs(), F)
    if config.time_step:
        scene.simulator.AdvanceTo(config.time_step)
        assert scene.velocity("tool")[5] == pytest.approx(1e-4 * K / MASS * 1e-3)


def test_two_free_bodies_keep_their_momentum(tmp_path):
    scene = PlantScene(PLANTS["unsampled"])
    scene.add("tool", CUBE, mass=0.1)
    scene.add("cart", Sphere(0.03), mass=0.3)
    scene.finalize(gravity=0.0)
    rendering = render(scene)
    scene.start(
        tool=RigidTransform(RollPitchYaw(0.3, 0.5, 0.2), [0, 0, 0.07]),
        cart=RigidTransform([0.005, 0.003, 0.0]),
    )
    plant, context = scene.plant, scene.context
    plant.SetVelocities(
        context, [0.1, 0.2, -0.3, 0.0, 0.01, -0.5, 0.0, 0.3, 0.0, 0.02, 0.0, 0.1]
    )

    def momentum():
        L = plant.CalcSpatialMomentumInWorldAboutPoint(context, np.zeros(3))
        return np.concatenate([L.rotational(), L.translational()])

    start, forces = momentum(), []
    for step in range(1, 201):
        scene.simulator.AdvanceTo(step * 1e-3)
        forces.append(scene.read(rendering, "F_To_W")[3:])
    assert np.linalg.norm(forces, axis=1).max() > 1.0
    np.testing.assert_array_equal(forces[-1], np.zeros(3))
    np.testing.assert_allclose(momentum(), start, rtol=0, atol=1e-14)


def make_peg_and_ring(folder, gravity=G):
    """Returns a finalized scene of a peg, 2.5 mm narrower than a ring about z."""
    ring = trimesh.creation.annulus(0.0125, 0.04, 0.04, sections=48)
    ring.export(folder / "ring.obj")
    scene = PlantScene()
    scene.add("tool", Cylinder(0.01, 0.06), mass=MASS)
    scene.add_fixed("block", Mesh(folder / "ring.obj"))
    return scene.finalize(gravity)


def test_a_peg_goes_into_a_hole_that_drakes_hull_would_close(tmp_path):
    def drop(haptic):
        scene = make_peg_and_ring(tmp_path)
        if haptic:
            render(scene)
        scene.start(tool=RigidTransform([1e-3, 0.5e-3, 0.055]))
        scene.simulator.AdvanceTo(0.09)
        return scene.pose("tool").translation()

    # Falling freely for 0.09 s: the tip is 2 cm above the bottom of the hole.
    fallen = 0.055 - 0.5 * G * 0.09**2
    assert fallen < 0.02
    assert drop(haptic=True)[2] == pytest.approx(fallen, abs=2e-3)
    assert drop(haptic=False)[2] > 0.045


def test_a_hole_guides_a_peg_that_is_pressed_aside(tmp_path):
    scene = make_peg_and_ring(tmp_path, gravity=0.0)
    push(scene, [0.5, 0.0, 0.0])
    rendering = render(
        scene, contact=ContactParameters(tolerance_m=5e-4, stiffness_N_per_m=K)
    )
    scene.start(tool=RigidTransform())
    scene.simulator.AdvanceTo(1.0)
    assert len(scene.read(rendering, "contacts")) > 0
    # The clearance is 2.5 mm less the tolerance, and a spring gives way.
    assert scene.pose("tool").translation()[0] == pytest.approx(0.002, abs=6e-4)


def push(scene, f):
    """Connects a force f (3,) N on the tool, as a user would."""
    body = scene.plant.GetBodyByName("tool")
    port = scene.plant.get_applied_spatial_force_input_port()
    scene.builder.Connect(make_push(scene.builder, body, f), port)


def test_a_users_own_force_acts_beside_it():
    scene = over_a_slab(CUBE)
    push(scene, [0.0, 0.0, 0.5 * MASS * G])
    render(scene)
    scene.start(tool=RigidTransform([0, 0, REST]))
    scene.simulator.AdvanceTo(1.5)
    expected = REST + 0.5 * MASS * G / K
    assert scene.pose("tool").translation()[2] == pytest.approx(expected, abs=1e-6)


def count_own_contacts(scene):
    return scene.read(scene.plant, "contact_results").num_point_pair_contacts()


def test_drakes_own_contact_does_not_act_a_second_time():
    scene = over_a_slab(CUBE, "tool", "brick")
    with pytest.warns(SceneWarning, match="between 'tool' and 'brick'"):
        render(scene, environment=["slab"])
    deep = RigidTransform([0.0, 0.0, 0.5 * HALF])
    away = RigidTransform([0.2, 0.0, 0.5 * HALF])
    scene.start(tool=deep, brick=away)
    scene.simulator.AdvanceTo(1e-3)
    # Only the brick's contact with the slab is Drake's.
    assert count_own_contacts(scene) == 1
    scene.place("brick", deep)
    scene.simulator.AdvanceTo(2e-3)
    # What is not rendered is still touched as Drake does.
    assert count_own_contacts(scene) == 2


def test_of_two_calls_for_one_tool_the_last_knows_what_is_left_to_drake():
    scene = over_a_slab(CUBE, "tool", "brick")
    with pytest.warns(SceneWarning) as caught:
        render(scene, environment=["slab"], name="on_slab")
    (warning,) = caught
    assert "acts between 'tool' and 'brick', unless another call" in str(
        warning.message
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        render(scene, environment=["brick"], name="on_brick")
    # In the end no contact counts twice, and none is Drake's.
    deep = RigidTransform([0.0, 0.0, 0.5 * HALF])
    scene.start(tool=deep, brick=RigidTransform([0.0, HALF, 3 * HALF]))
    scene.simulator.AdvanceTo(1e-3)
    assert count_own_contacts(scene) == 0


def test_without_rendering_drakes_contact_would_act():
    scene = over_a_slab(CUBE).start(tool=RigidTransform([0.0, 0.0, 0.5 * HALF]))
    scene.simulator.AdvanceTo(1e-3)
    assert count_own_contacts(scene) == 1


def test_nothing_is_warned_of_where_nothing_is_wrong():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make_scene()


def test_bodies_at_rest_have_no_ports_and_moving_ones_do():
    rendering = render(over_a_slab(CUBE, "tool", "cart"))
    inputs = map(rendering.get_input_port, range(rendering.num_input_ports()))
    assert [port.get_name() for port in inputs] == [
        "body_poses",
        "body_spatial_velocities",
        "state",
    ]
    assert rendering.HasOutputPort("X_WO_cart")
    assert not rendering.HasOutputPort("X_WO_slab")
    assert [item.name for item in rendering.objects] == ["cart", "slab"]


def test_a_material_takes_the_place_of_the_contacts_gains():
    scene, rendering = make_scene(materials={"slab": Material(stiffness_N_per_m=5e3)})
    scene.start(tool=RigidTransform([0, 0, HALF]))
    F = scene.read(rendering, "F_To_W")
    assert F[5] == pytest.approx(5e3 * SOFT.tolerance_m)


def test_shapes_for_illustration_are_used_if_asked_for():
    scene = PlantScene()
    tool = scene.add("tool")
    scene.plant.RegisterVisualGeometry(tool, RigidTransform(), CUBE, "look", np.ones(4))
    slab = scene.add_slab()
    scene.plant.RegisterVisualGeometry(
        slab, RigidTransform([0, 0, -0.05]), Box(1, 1, 0.1), "look", np.ones(4)
    )
    scene.finalize()
    rendering = render(scene, role=Role.kIllustration)
    scene.start(tool=RigidTransform([0, 0, REST]))
    assert scene.read(rendering, "F_To_W")[5] == pytest.approx(MASS * G)


@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_the_stiffness_that_is_warned_of_is_the_one_that_fails(factor):
    """A ball on its lowest corner: translation only, so that the bound is sharp."""
    limit = 4 * MASS / 1e-3**2
    scene = PlantScene(PLANTS["unsampled"])
    tool = scene.plant.AddRigidBody(
        "tool", SpatialInertia.SolidSphereWithMass(MASS, 1e3)
    )
    scene.touchable(tool, Sphere(HALF))
    scene.add_slab()
    scene.finalize()
    stiff = ContactParameters(stiffness_N_per_m=factor * limit, damping_Ns_per_m=0.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        rendering = render(scene, contact=stiff)
    assert bool(caught) == (factor > 1)
    # At rest but for a hundredth of the spring's way.
    scene.start(tool=RigidTransform([0, 0, HALF + stiff.tolerance_m]))
    gap = scene.read(rendering, "contacts").distance[0] - stiff.tolerance_m
    sag = MASS * G / stiff.stiffness_N_per_m
    z = HALF + stiff.tolerance_m - gap - 1.01 * sag
    scene.place("tool", RigidTransform([0, 0, z]))
    scene.simulator.AdvanceTo(0.05)
    weight = scene.read(rendering, "F_To_W")[5] / (MASS * G)
    assert (abs(weight - 1.0) < 0.1) == (factor < 1)


def test_a_stiffness_that_a_discrete_plant_does_not_hold_is_warned_of():
    stiff = ContactParameters(stiffness_N_per_m=1e6)
    with pytest.warns(SceneWarning, match=r"contact of 'tool' with 'slab'.*time_step"):
        make_scene(contact=stiff)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make_scene(PLANTS["continuous"], contact=stiff)


def test_a_coupling_that_a_discrete_plant_does_not_hold_is_warned_of():
    stiff = CouplingParameters(rotational_damping_Nms_per_rad=0.2)
    with pytest.warns(SceneWarning, match=r"coupling of 'tool': .* N·m/rad"):
        make_scene(coupling=stiff)


def test_two_tools_may_meet_the_same_slab():
    scene = over_a_slab(CUBE, "left", "right")
    with pytest.warns(SceneWarning, match="'left' and 'right'"):
        render(scene, "left", environment=["slab"], name="of_left")
    with pytest.warns(SceneWarning, match="'right' and 'left'"):
        render(scene, "right", environment=["slab"], name="of_right")
    scene.start(
        left=RigidTransform([-0.1, 0, REST]), right=RigidTransform([0.1, 0, REST])
    )
    scene.simulator.AdvanceTo(0.2)
    for name in ("left", "right"):
        assert scene.pose(name).translation()[2] == pytest.approx(REST, abs=1e-6)


def test_a_plant_that_cannot_be_used_is_refused():
    scene = PlantScene()
    scene.add("tool", CUBE)
    scene.add_slab()
    with pytest.raises(ValueError, match=r"plant: call plant.Finalize\(\)"):
        render(scene)
    scene.finalize()
    with pytest.raises(ValueError, match="plant: is not in the builder"):
        AddHapticRendering(DiagramBuilder(), scene.plant, scene.scene_graph, "tool")
    with pytest.raises(ValueError, match="scene_graph: is not the plant's"):
        AddHapticRendering(scene.builder, scene.plant, SceneGraph(), "tool")
    scene.start()
    with pytest.raises(ValueError, match="builder: is built already"):
        render(scene)


def test_a_plant_without_a_scene_graph_is_refused():
    scene = PlantScene()
    plant = scene.builder.AddSystem(MultibodyPlant(0.0))
    plant.Finalize()
    with pytest.raises(ValueError, match="plant: has no scene graph"):
        AddHapticRendering(scene.builder, plant, scene.scene_graph, "tool")


def test_a_name_that_is_taken_is_refused():
    scene, _ = make_scene()
    with pytest.raises(ValueError, match=r"name: .* 'haptic_rendering' already.*name="):
        render(scene)


def test_contact_of_two_bodies_counts_once():
    scene = over_a_slab(CUBE, "tool", "other")
    render(scene)
    for tool, environment in [("tool", ["slab"]), ("other", ["slab", "tool"])]:
        with pytest.raises(ValueError, match="'haptic_rendering' already"):
            render(scene, tool, environment=environment, name="second")
    second = render(scene, "other", name="second")
    assert [item.name for item in second.objects] == ["slab"]


def test_one_name_is_no_list_of_bodies():
    with pytest.raises(ValueError, match=r"environment: is a list .* \['slab'\]"):
        make_scene(environment="slab")


def test_a_period_must_be_positive():
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        make_scene(period_s=0.0)


def test_materials_that_mean_nothing_are_refused():
    for materials, effects, message in [
        ({"slob": Material()}, Effects(), "materials: there is no 'slob' .* are slab"),
        (
            {"slab": Material(friction_coefficient=1.0)},
            Effects(shading=ShadingParameters()),
            r"\['slab'\]\.friction_coefficient means nothing without effects.friction",
        ),
        (
            {"slab": Material(shading=False)},
            Effects(friction=FrictionParameters()),
            r"\['slab'\]\.shading means nothing without effects.shading",
        ),
    ]:
        with pytest.raises(ValueError, match=message):
            make_scene(materials=materials, effects=effects)


@pytest.mark.parametrize(
    "options, message",
    [
        (
            {"contact": ContactParameters(clustering="octre")},
            r"contact\.clustering .*'octree'",
        ),
        (
            {"contact": ContactParameters(clustering="octree")},
            r"contact\.cluster_size_m is miss",
        ),
        (
            {"coupling": CouplingParameters(damping_Ns_per_m=-1.0)},
            r"coupling\.damping_Ns_per_m",
        ),
        (
            {"effects": Effects(friction=FrictionParameters(-0.3))},
            r"friction\.coefficient must",
        ),
        ({"materials": {"slab": Material(-1.0)}}, r"materials\['slab'\]\.stiffness"),
        ({"chord_error_m": 0.0}, "chord_error_m must be positive"),
    ],
)
def test_a_value_out_of_its_range_is_refused_by_the_name_it_was_given(options, message):
    with pytest.raises(ValueError, match=message):
        make_scene(**options)


def test_what_was_refused_leaves_the_builder_as_it_was():
    scene = over_a_slab(CUBE)
    with pytest.raises(ValueError, match="tolerance"):
        render(scene, contact=ContactParameters(tolerance_m=-1.0))
    assert len(scene.builder.GetSystems()) == 2
    port = scene.plant.get_applied_spatial_force_input_port()
    assert not scene.builder.IsConnectedOrExported(port)
    scene.builder.ExportInput(port, "applied")
    with pytest.raises(ValueError, match="is exported"):
        render(scene)
    assert len(scene.builder.GetSystems()) == 2


def test_progress_names_the_bodies(tmp_path):
    trimesh.creation.annulus(0.02, 0.04, 0.01).export(tmp_path / "ring.obj")
    scene = PlantScene()
    scene.add("tool", Mesh(tmp_path / "ring.obj"))
    scene.add_slab()
    calls = []
    render(scene.finalize(), progress=lambda *call: calls.append(call))
    assert calls[-1] == ("tool", 1.0)
