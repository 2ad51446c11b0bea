"""The diagram between a plant's ports: what is in it, what it shows and refuses."""

from dataclasses import replace

import numpy as np
import pytest
from cube_scene import CONTACT, CUBE, HALF, MASS, G, make_scene
from diagram_parts import inputs, names, outputs, sources
from plant_scenes import PLANTS, over_a_slab
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.primitives import ConstantVectorSource
from slider_device import make_device

from drake_haptics.common.errors import SceneError
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    CouplingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    PassivityParameters,
    ShadingParameters,
)

REST = HALF + CONTACT.tolerance_m - MASS * G / 1e3
BASE = {
    "body_motions",
    "state_parts",
    "contact_query",
    "contact_clustering",
    "penalty_force",
    "applied_wrenches",
}
INPUTS = {"body_poses", "body_spatial_velocities", "state"}
OUTPUTS = {
    "applied_spatial_force",
    "X_WT",
    "V_WT",
    "contacts",
    "clusters",
    "contact_wrench",
    "F_To_W",
}


def test_without_effects_there_is_only_contact():
    _, rendering = make_scene()
    assert names(rendering) == BASE
    assert outputs(rendering) == OUTPUTS
    assert inputs(rendering) == INPUTS
    # A state of its own would be a sample of delay.
    assert rendering.CreateDefaultContext().num_total_states() == 0


def test_a_wrong_query_rate_is_told_by_the_period_that_it_must_fit():
    contact = replace(CONTACT, query_rate_hz=300.0)
    says = r"must be 1 / period_s \(1000\) divided by a whole number, is 300"
    with pytest.raises(SceneError, match=says):
        make_scene(config=PLANTS["sampled"], contact=contact)


@pytest.mark.parametrize(
    ("plant", "period_s", "query_rate_hz", "step_s"),
    [
        ("sampled", None, None, 1e-3),
        # A period of effects makes a discrete plant no faster and no slower.
        ("sampled", 1e-4, None, 1e-3),
        ("sampled", 1e-2, None, 1e-3),
        ("sampled", None, 250.0, 4e-3),
        ("sampled", 1e-4, 10000.0, 1e-3),
        ("continuous", 1e-4, None, 1e-4),
    ],
)
def test_the_skin_speed_crosses_the_tolerance_in_one_step_of_the_plant(
    plant, period_s, query_rate_hz, step_s
):
    contact = replace(CONTACT, query_rate_hz=query_rate_hz)
    _, rendering = make_scene(config=PLANTS[plant], contact=contact, period_s=period_s)
    assert rendering.skin_speed_m_per_s == pytest.approx(CONTACT.tolerance_m / step_s)


def test_what_free_bodies_feel_comes_from_the_state_whatever_its_quaternions_length():
    scene, rendering = make_scene(cart=True)
    fed = sources(rendering)
    for port in ("contact_query.X_WT", "penalty_force.V_WT", "penalty_force.V_WO_cart"):
        assert fed[port].startswith("state_parts.")
    turned = RollPitchYaw(0.5, 0.4, 0.2)
    scene.start(
        tool=RigidTransform(turned, [0, 0, HALF]), cart=RigidTransform([0.05, 0, HALF])
    )
    forces = []
    for length in (1.0, -3.0):
        q = scene.plant.GetPositions(scene.context).copy()
        q[:4] *= length
        scene.plant.SetPositions(scene.context, q)
        forces.append(scene.read(rendering, "F_To_W"))
    assert forces[0][5] > 1.0
    np.testing.assert_allclose(forces[1], forces[0], atol=1e-12)


def test_a_body_that_moves_has_ports_and_a_reaction():
    _, rendering = make_scene(cart=True)
    assert outputs(rendering) == OUTPUTS | {"X_WO_cart", "V_WO_cart", "F_O_W"}
    assert rendering.GetOutputPort("F_O_W").size() == 6


@pytest.mark.parametrize(
    ("effects", "systems", "ports"),
    [
        (Effects(shading=ShadingParameters()), {"force_shading"}, set()),
        (
            Effects(friction=FrictionParameters()),
            {"stick_slip_friction", "stick_slip_friction_wrench"},
            {"friction_force"},
        ),
        (
            Effects(braking=BrakingParameters()),
            {"pre_contact_braking", "pre_contact_braking_wrench"},
            set(),
        ),
    ],
)
def test_an_effect_adds_its_systems_and_no_others(effects, systems, ports):
    scene, rendering = make_scene(effects=effects)
    assert names(rendering) == BASE | systems
    assert outputs(rendering) == OUTPUTS | ports
    scene.start(tool=RigidTransform([0, 0, REST]))
    scene.simulator.AdvanceTo(0.1)
    assert scene.pose("tool").translation()[2] == pytest.approx(REST, abs=1e-6)


def test_what_is_shaded_is_what_is_clustered_and_shown():
    scene, rendering = make_scene(effects=Effects(shading=ShadingParameters()))
    fed = sources(rendering)
    assert fed["force_shading.contacts"] == "contact_query.contacts"
    assert fed["contact_clustering.contacts"] == "force_shading.contacts"
    scene.start(tool=RigidTransform([0, 0, REST]))
    shading = rendering.GetSubsystemByName("force_shading")
    shaded = scene.read(shading, "contacts")
    assert scene.read(rendering, "contacts") is shaded


@pytest.mark.parametrize("config", PLANTS.values(), ids=PLANTS)
def test_friction_stops_a_body_that_slides(config):
    def slide(effects):
        scene, _ = make_scene(effects=effects, config=config)
        scene.start(tool=RigidTransform([0, 0, REST]))
        scene.plant.SetVelocities(scene.context, [0, 0, 0, 0.2, 0, 0])
        scene.simulator.AdvanceTo(0.3)
        return scene.pose("tool").translation()[0]

    assert slide(Effects()) == pytest.approx(0.2 * 0.3, abs=1e-6)
    # It slides for v² / (2 μ g), within the give of what sticks and its tilt.
    expected = 0.2**2 / (2 * 0.3 * G)
    found = slide(Effects(friction=FrictionParameters(coefficient=0.3)))
    assert found == pytest.approx(expected, abs=1e-3)


@pytest.mark.filterwarnings("ignore:Drake's own contact")
def test_one_tool_may_meet_bodies_in_two_ways():
    """With braking what stands still, without it what moves."""
    scene = over_a_slab(CUBE, "tool", "cart")
    braked, plain = (
        scene.render(
            environment=[body], contact=CONTACT, effects=effects, name=f"on_{body}"
        )
        for body, effects in [
            ("slab", Effects(braking=BrakingParameters())),
            ("cart", Effects()),
        ]
    )
    gap = CONTACT.tolerance_m - 1e-3
    scene.start(
        tool=RigidTransform([0, 0, REST]), cart=RigidTransform([2 * HALF + gap, 0, 0.5])
    )
    scene.place("cart", RigidTransform([2 * HALF + gap, 0, REST]))
    scene.simulator.AdvanceTo(1e-3)
    assert scene.read(plain, "F_To_W")[3] < -0.9
    assert scene.velocity("cart")[3] == pytest.approx(1.0 / 0.1 * 1e-3, rel=1e-6)
    assert scene.read(braked, "F_To_W")[5] == pytest.approx(MASS * G, rel=1e-3)


def measure_momentum(plant, context):
    """Returns the momentum [about the world's origin; linear]."""
    L = plant.CalcSpatialMomentumInWorldAboutPoint(context, np.zeros(3))
    return np.concatenate([L.rotational(), L.translational()])


def test_bodies_that_rub_keep_their_momentum():
    scene, rendering = make_scene(
        cart=True,
        gravity=0.0,
        effects=Effects(friction=FrictionParameters(coefficient=0.5)),
    )
    assert "friction_reaction" in names(rendering)
    # Far from the slab, pressed together, and sliding along each other.
    gap = CONTACT.tolerance_m - 2e-3
    scene.start(
        tool=RigidTransform([0, 0, 1.0]),
        cart=RigidTransform([2 * HALF + gap, 0.005, 1.003]),
    )
    plant, context = scene.plant, scene.context
    plant.SetVelocities(context, [0, 0, 0, 0, 0.2, 0.1, 0, 0, 0, 0, -0.1, 0])
    start, rubbed = measure_momentum(plant, context), 0.0
    for step in range(1, 21):
        scene.simulator.AdvanceTo(step * 1e-3)
        forces = scene.read(rendering, "friction_force").f_cluster_W
        rubbed = max(rubbed, np.linalg.norm(forces.sum(axis=0)))
    assert rubbed > 0.2
    end = measure_momentum(plant, context)
    np.testing.assert_allclose(end, start, rtol=0, atol=1e-14)


def test_bodies_that_brake_each_other_keep_their_momentum():
    scene, rendering = make_scene(
        cart=True,
        gravity=0.0,
        effects=Effects(
            braking=BrakingParameters(damping_Ns_per_m=5.0, distance_m=4e-3)
        ),
    )
    # Far from the slab and not in contact yet, one turned against the other.
    turned = RollPitchYaw(0.0, 0.0, 0.1)
    scene.start(
        tool=RigidTransform([0, 0, 1.0]),
        cart=RigidTransform(turned, [2 * HALF + 4.5e-3, 0.005, 1.003]),
    )
    plant, context = scene.plant, scene.context
    plant.SetVelocities(context, [0, 0, 0, 0.2, 0, 0, 0, 1.0, 0, -0.1, 0, 0])
    start = measure_momentum(plant, context)
    speed = [scene.velocity(name)[3] for name in ("tool", "cart")]
    braked = 0.0
    for step in range(1, 11):
        scene.simulator.AdvanceTo(step * 1e-3)
        braking = rendering.GetSubsystemByName("pre_contact_braking")
        braked = max(braked, np.linalg.norm(scene.read(braking, "F_O_W")[3:]))
    assert braked > 0.2
    assert scene.velocity("tool")[3] < speed[0] - 0.01
    assert scene.velocity("cart")[3] > speed[1] + 0.01
    end = measure_momentum(plant, context)
    np.testing.assert_allclose(end, start, rtol=0, atol=1e-14)


def test_braking_takes_the_speed_that_it_says():
    effects = Effects(braking=BrakingParameters(damping_Ns_per_m=20.0, distance_m=4e-3))
    contact = ContactParameters(tolerance_m=0.0, damping_Ns_per_m=0.0)
    scene, _ = make_scene(
        config=PLANTS["continuous"], gravity=0.0, contact=contact, effects=effects
    )
    scene.start(tool=RigidTransform([0, 0, HALF + 5e-3]))
    scene.plant.SetVelocities(scene.context, [0, 0, 0, 0, 0, -1.0])
    scene.simulator.get_mutable_integrator().set_target_accuracy(1e-8)
    while scene.pose("tool").translation()[2] > HALF + 1e-5:
        scene.simulator.AdvanceTo(scene.simulator.get_context().get_time() + 1e-5)
    lost = 2 * 20.0 * 4e-3 / (3 * MASS)
    assert scene.velocity("tool")[5] == pytest.approx(-(1.0 - lost), abs=0.01)


def hold_handle(scene, rendering, X_WH):
    """Connects a handle that is held still."""
    for name, value in [("X_WH", pose_to_vector(X_WH)), ("V_WH", np.zeros(6))]:
        source = scene.builder.AddSystem(ConstantVectorSource(value))
        scene.builder.Connect(source.get_output_port(), rendering.GetInputPort(name))


def test_a_handle_outside_holds_the_tool_and_feels_it():
    coupling = CouplingParameters(stiffness_N_per_m=500.0)
    X_HT = RigidTransform([0.0, 0.0, -0.1])
    scene, rendering = make_scene(coupling=coupling, X_HT=X_HT)
    assert inputs(rendering) - INPUTS == {"X_WH", "V_WH"}
    assert outputs(rendering) == OUTPUTS | {"F_Ho_W_commanded"}
    coupled = {"virtual_coupling", "virtual_coupling_wrench", "X_WH", "V_WH"}
    assert names(rendering) == BASE | coupled
    hold_handle(scene, rendering, RigidTransform([0, 0, 0.4]))
    scene.start(tool=RigidTransform([0, 0, 0.3]))
    scene.simulator.AdvanceTo(1.0)
    sag = MASS * G / 500.0
    assert scene.pose("tool").translation()[2] == pytest.approx(0.3 - sag, abs=1e-6)
    F = scene.read(rendering, "F_Ho_W_commanded")
    np.testing.assert_allclose(F[3:], [0, 0, -MASS * G], atol=1e-4)
    # The contact's own output is without the coupling.
    np.testing.assert_array_equal(scene.read(rendering, "F_To_W"), np.zeros(6))


@pytest.mark.parametrize("left_out", ["X_WH", "V_WH"])
def test_a_handle_that_is_not_connected_is_named(left_out):
    scene, rendering = make_scene(coupling=CouplingParameters())
    (given,) = {"X_WH", "V_WH"} - {left_out}
    value = pose_to_vector(RigidTransform()) if given == "X_WH" else np.zeros(6)
    source = scene.builder.AddSystem(ConstantVectorSource(value))
    scene.builder.Connect(source.get_output_port(), rendering.GetInputPort(given))
    scene.start(tool=RigidTransform([0, 0, 0.3]))
    with pytest.raises(RuntimeError, match=f"::{left_out} .* is not connected"):
        scene.simulator.AdvanceTo(0.01)


@pytest.mark.parametrize("law", ["penalty", "constraint"])
@pytest.mark.parametrize(("lost", "size"), [("X_WH", 7), ("V_WH", 6)])
def test_a_handle_that_is_nowhere_is_refused_at_its_port(lost, size, law):
    scene, rendering = make_scene(
        coupling=CouplingParameters(), contact=ContactParameters(law=law)
    )
    hold_handle(scene, rendering, RigidTransform([0, 0, 0.3]))
    scene.start(tool=RigidTransform([0, 0, 0.3]))
    rendering.GetInputPort(lost).FixValue(
        rendering.GetMyMutableContextFromRoot(scene.root), np.full(size, np.nan)
    )
    says = rf"::haptic_rendering::{lost} must be finite, is \[nan"
    with pytest.raises(FloatingPointError, match=says):
        scene.simulator.AdvanceTo(0.01)


@pytest.mark.parametrize(
    ("law", "pose"), [("penalty", "X_WT"), ("constraint", "q_W[TH]")]
)
def test_of_a_motion_that_has_diverged_the_pose_is_named(law, pose):
    scene, _ = make_scene(contact=ContactParameters(law=law), config=PLANTS["sampled"])
    scene.start(tool=RigidTransform([0, 0, 0.3]))
    state = scene.context.get_mutable_discrete_state(0)
    state.set_value(np.full(state.size(), np.nan))
    with pytest.raises(ValueError, match=f"{pose} .* finite"):
        scene.simulator.AdvanceTo(0.01)


def start_with_handle(scene, rendering, speed):
    """Starts with tool and coupling at rest, and the handle, on its slider, moving."""
    scene.start(tool=RigidTransform([0, 0, REST]))
    device = rendering.GetSubsystemByName("device")
    slider = device.GetSubsystemByName("slider")
    context = slider.GetMyMutableContextFromRoot(scene.root)
    context.SetContinuousState([0.0, speed])


def test_a_device_inside_is_shown_the_contact():
    X_HT = RigidTransform([0, 0, REST])
    scene, rendering = make_scene(
        coupling=CouplingParameters(), device=make_device(), X_HT=X_HT
    )
    assert inputs(rendering) == INPUTS
    device_ports = {"F_Ho_W_commanded", "X_WH", "V_WH", "F_Ho_W_rendered", "status"}
    assert outputs(rendering) == OUTPUTS | device_ports
    assert "device" in names(rendering)
    start_with_handle(scene, rendering, -0.1)
    scene.simulator.AdvanceTo(0.02)
    # The handle presses the tool down, and is pressed up.
    assert scene.pose("tool").translation()[2] < REST - 1e-4
    assert scene.read(rendering, "F_Ho_W_rendered")[5] > 0.1
    scene.simulator.AdvanceTo(3.0)
    # At rest the handle is where the tool is borne.
    assert scene.pose("tool").translation()[2] == pytest.approx(REST, abs=1e-5)
    np.testing.assert_allclose(scene.read(rendering, "X_WH")[4:], 0.0, atol=1e-5)


def test_passivity_control_goes_before_a_device():
    effects = Effects(passivity=PassivityParameters())
    X_HT = RigidTransform([0, 0, REST])
    scene, rendering = make_scene(
        coupling=CouplingParameters(), device=make_device(), effects=effects, X_HT=X_HT
    )
    assert "passivity_control" in names(rendering)
    start_with_handle(scene, rendering, -0.1)
    scene.simulator.AdvanceTo(0.005)
    # The world has got what the handle has lost, but for the slider's damping.
    v = scene.read(rendering, "V_WH")[5]
    lost = 0.5 * 0.1 * (0.1**2 - v**2)
    energy = scene.read(rendering, "energy_J")[0]
    assert energy == pytest.approx(lost, rel=0.2)


def test_what_would_mean_nothing_is_refused():
    for options, message in [
        ({"device": make_device()}, "device: needs a coupling"),
        (
            {"effects": Effects(gravity=GravityParameters())},
            "gravity: the plant's own gravity",
        ),
        (
            {"effects": Effects(passivity=PassivityParameters())},
            "passivity needs a device",
        ),
        (
            {
                "effects": Effects(passivity=PassivityParameters()),
                "coupling": CouplingParameters(),
            },
            "passivity needs a device",
        ),
    ]:
        with pytest.raises(ValueError, match=message):
            make_scene(**options)


def test_a_gain_out_of_range_is_named():
    with pytest.raises(ValueError, match="stiffness_N_per_m"):
        make_scene(contact=ContactParameters(stiffness_N_per_m=-1.0))
