"""The constraint law in plants: a proxy is stopped, and its body is drawn to it."""

from __future__ import annotations

import numpy as np
import pytest
from plant_scenes import PLANTS, G, PlantScene, over_a_slab
from press_tools import MODELS
from pydrake.geometry import Box, Mesh, Sphere
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.tree import PrismaticJoint, PrismaticSpring, SpatialInertia
from pydrake.systems.analysis import InitializeParams, Simulator
from pydrake.systems.primitives import ConstantVectorSource, TrajectorySource
from pydrake.trajectories import PiecewisePolynomial

from drake_haptics.analysis import find_equilibrium
from drake_haptics.bounds.explicit_step import calc_explicit_stiffness
from drake_haptics.common.errors import SceneError
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.rendering.proxy import calc_proxy_gains
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    FrictionParameters,
)
from drake_haptics.scene.validation import SceneWarning

SKIN = 3e-4
CONSTRAINT = ContactParameters(law="constraint", skin_m=SKIN)
STEP, MASS, HALF = 1e-3, 0.1, 0.01
CUBE = Box(2 * HALF, 2 * HALF, 2 * HALF)
# What the proxy of such a cube holds.
HELD = CouplingParameters(rotational_damping_Nms_per_rad=3e-3)
plants = pytest.mark.parametrize("config", PLANTS.values(), ids=PLANTS)


def render(scene, *, contact=CONSTRAINT, **options):
    return scene.render(contact=contact, **options)


def rest_on_a_slab(config=PLANTS["sampled"], **options):
    """Returns a finalized scene of a cube over a slab, and its rendering."""
    scene = over_a_slab(CUBE, config=config, mass=MASS, side=2 * HALF)
    return scene, render(scene, **options)


def throw(scene, v, w=(0, 0, 0), name="tool"):
    body = scene.plant.GetBodyByName(name)
    free = scene.plant.GetVelocities(scene.context)
    start = body.floating_velocities_start_in_v()
    free[start : start + 6] = [*w, *v]
    scene.plant.SetVelocities(scene.context, free)


def proxy_z(scene, rendering):
    return scene.read(rendering, "X_WP")[6]


@plants
def test_a_cube_rests_on_its_skin_and_sinks_by_its_weight(config):
    scene, rendering = rest_on_a_slab(config)
    scene.start(tool=RigidTransform([0, 0, 0.015])).simulator.AdvanceTo(0.5)
    assert proxy_z(scene, rendering) == pytest.approx(HALF + SKIN, abs=1e-7)
    sunk = MASS * G / rendering.proxy_gains.stiffness_N_per_m
    assert scene.pose("tool").translation()[2] == pytest.approx(
        HALF + SKIN - sunk, abs=1e-6
    )
    assert scene.read(rendering, "F_To_W")[5] == pytest.approx(MASS * G, rel=1e-4)
    assert np.abs(scene.velocity("tool")).max() < 1e-5


def test_a_copy_of_a_context_goes_on_as_the_original():
    scene, rendering = rest_on_a_slab()
    scene.start(tool=RigidTransform([0, 0, 0.015])).simulator.AdvanceTo(0.1)

    def z_of_copy(params):
        copy = Simulator(scene.diagram, scene.root.Clone())
        copy.Initialize(params)
        copy.AdvanceTo(0.15)
        at = rendering.GetMyContextFromRoot(copy.get_context())
        return rendering.GetOutputPort("X_WP").Eval(at)[6]

    kept = z_of_copy(InitializeParams(suppress_initialization_events=True))
    put_back = z_of_copy(InitializeParams())
    scene.simulator.AdvanceTo(0.15)
    assert kept == proxy_z(scene, rendering) != put_back


@plants
def test_a_body_that_touches_nothing_falls_as_it_would(config):
    """Its proxy is no burden to it."""
    scene, rendering = rest_on_a_slab(config)
    scene.start(tool=RigidTransform([0, 0, 1])).simulator.AdvanceTo(0.1)
    assert scene.velocity("tool")[5] == pytest.approx(-G * 0.1, rel=1e-9)
    # To the one step that the proxy may be ahead, or what it falls in one.
    away = proxy_z(scene, rendering) - scene.pose("tool").translation()[2]
    assert abs(away) < 1.1 * G * STEP**2


def hold(scene, rendering, X_WH):
    """Connects a handle that is at (n, 7) poses, one a second, and counts as still."""
    times = np.arange(float(len(X_WH)))
    path = PiecewisePolynomial.FirstOrderHold(times, np.transpose(X_WH))
    handle = scene.builder.AddSystem(TrajectorySource(path))
    still = scene.builder.AddSystem(ConstantVectorSource(np.zeros(6)))
    scene.builder.Connect(handle.get_output_port(), rendering.GetInputPort("X_WH"))
    scene.builder.Connect(still.get_output_port(), rendering.GetInputPort("V_WH"))


@pytest.mark.parametrize("shape", [CUBE, Sphere(HALF)], ids=["cube", "ball"])
@plants
def test_a_tool_that_is_held_in_a_cup_rests_still(config, shape):
    """Pressed with 5 N into a hollow of facets; the hand feels where the proxy is."""
    scene = PlantScene(config)
    scene.add_fixed("cup", Mesh(str(MODELS / "cup.obj")))
    scene.add("tool", shape, mass=MASS, side=2 * HALF)
    rendering = render(scene.finalize(), coupling=HELD)
    q_WH = [1, 0, 0, 0, 0.01, 0.005, 0.01]
    hold(scene, rendering, [q_WH, q_WH, q_WH])
    scene.start(tool=RigidTransform([0.008, 0.005, 0.07])).simulator.AdvanceTo(1.5)
    forces = []
    for k in range(100):
        scene.simulator.AdvanceTo(1.5 + k * STEP)
        assert np.abs(scene.velocity("tool")).max() < 1e-4
        forces.append(scene.read(rendering, "F_Ho_W_commanded")[3:])
    assert np.ptp(forces, axis=0).max() < 1e-3
    assert forces[-1][2] > 4.0
    stretch_m = scene.read(rendering, "X_WP")[4:] - q_WH[4:]
    np.testing.assert_allclose(forces[-1], 800.0 * stretch_m, atol=1e-3)


@plants
def test_nothing_carries_a_body_through_a_thin_wall(config):
    """A cube at 1 m/s on a plate of 0.1 mm, a tenth of what it goes in a step.

    The body sinks in until it is stopped. The proxy keeps what a fast turn leaves of
    its skin: a row is of first order in rotations.
    """
    scene = PlantScene(config)
    scene.add_fixed("plate", Box(0.1, 0.1, 1e-4))
    scene.add("tool", CUBE, mass=MASS, side=2 * HALF)
    rendering = render(scene.finalize(gravity=0.0))
    scene.start(tool=RigidTransform(RollPitchYaw(0.3, 0.2, 0), [0, 0, 0.03]))
    throw(scene, [0.1, 0, -1])
    corners = HALF * np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1)
    for k in range(1, 80):
        scene.simulator.AdvanceTo(k * STEP)
        X_WP = vector_to_pose(scene.read(rendering, "X_WP"))
        assert (X_WP @ corners)[2].min() > 5e-5 + 0.3 * SKIN
        assert (scene.pose("tool") @ corners)[2].min() > -2e-3
    assert scene.velocity("tool")[5] > -1e-3


@plants
def test_a_peg_goes_into_its_hole(config):
    """0.1 mm of play, askew by a degree and half a millimeter beside."""
    scene = PlantScene(config)
    scene.add_fixed("socket", Mesh(str(MODELS / "socket.obj")))
    scene.add("tool", Mesh(str(MODELS / "peg.obj")), mass=0.08, side=0.04)
    tight = ContactParameters(law="constraint", skin_m=8e-5)
    rendering = render(scene.finalize(), contact=tight, coupling=HELD)
    turn = RollPitchYaw(np.deg2rad([1, 0, 0])).ToQuaternion().wxyz()
    away, at, deep = ([*turn, 5e-4, 0, z] for z in (0.045, 0.034, 0.004))
    hold(scene, rendering, [away, at, deep, deep])
    scene.start(tool=vector_to_pose(np.array(away))).simulator.AdvanceTo(2.5)
    # The floor of the hole is 5 mm high.
    assert scene.read(rendering, "X_WP")[6] == pytest.approx(5e-3 + 8e-5, abs=2e-5)
    force_N = scene.read(rendering, "F_Ho_W_commanded")[3:]
    scene.simulator.AdvanceTo(2.7)
    later_N = scene.read(rendering, "F_Ho_W_commanded")[3:]
    np.testing.assert_allclose(later_N, force_N, atol=5e-3)


@plants
def test_a_collision_keeps_momentum_and_angular_momentum(config):
    """Of two free bodies of different mass that meet off their middles."""
    scene = PlantScene(config)
    scene.add("tool", CUBE, mass=MASS, side=2 * HALF)
    scene.add("other", Sphere(HALF), mass=0.3, side=2 * HALF)
    render(scene.finalize(gravity=0.0))
    scene.start(
        tool=RigidTransform(RollPitchYaw(0.2, 0.4, 0.1), [0, 4e-3, 0.03]),
        other=RigidTransform([0.002, -3e-3, 0]),
    )
    throw(scene, [0, 0, -0.5], [1, 2, 0])

    def momentum():
        L = scene.plant.CalcSpatialMomentumInWorldAboutPoint(scene.context, np.zeros(3))
        return L.get_coeffs()

    before = momentum()
    scene.simulator.AdvanceTo(0.1)
    speed = np.linalg.norm(scene.velocity("other")[3:])
    assert speed > 0.1
    np.testing.assert_allclose(momentum()[3:], before[3:], atol=1e-9)
    # Bodies move on while a force is held on them.
    arm_m = 0.5 * STEP if config.time_step == 0 else 1e-5
    np.testing.assert_allclose(momentum()[:3], before[:3], atol=0.3 * speed * arm_m)


def test_the_spring_of_a_proxy_is_stable_with_a_margin_of_a_third():
    """By the closed form, and by the roots of a mass against a wall."""
    mass, inertia = 0.05, 1e-5
    gains = calc_proxy_gains(mass, inertia, STEP)
    for m, K in [
        (mass, gains.stiffness_N_per_m),
        (inertia, gains.rotational_stiffness_Nm_per_rad),
    ]:
        for share in (0.5, 1.0, 1.32, 1.34):
            k = share * K
            is_bounded = k <= calc_explicit_stiffness(m, k * STEP, STEP)
            # v' = v - h K (x + h v)/m, x' = x + h v', of [x, h v].
            kept = 1 - k * STEP**2 / m
            step = np.array([[kept, kept], [kept - 1, kept]])
            radius = np.abs(np.linalg.eigvals(step)).max()
            assert is_bounded == (radius <= 1) == (share < 4 / 3)


def test_a_light_object_makes_the_spring_softer():
    """It rests on a spring of its own below a body twenty times as heavy."""
    scene = PlantScene()
    scene.add("tool", CUBE, mass=MASS, side=2 * HALF)
    inertia = SpatialInertia.SolidBoxWithMass(5e-3, 0.04, 0.04, 2e-3)
    key = scene.plant.AddRigidBody("key", inertia)
    scene.touchable(key, Box(0.04, 0.04, 2e-3))
    up = scene.plant.AddJoint(
        PrismaticJoint(
            "up", scene.plant.world_frame(), key.body_frame(), [0, 0, 1], damping=1.0
        )
    )
    scene.plant.AddForceElement(PrismaticSpring(up, 0.0, 500.0))
    rendering = render(scene.finalize())
    assert rendering.proxy_gains.stiffness_N_per_m * STEP**2 < 5e-3
    scene.start(tool=RigidTransform([0, 0, 0.012])).simulator.AdvanceTo(2)
    assert scene.read(rendering, "F_To_W")[5] == pytest.approx(MASS * G, rel=1e-3)
    sunk_m = 1.05 * MASS * G / 500.0
    assert scene.pose("key").translation()[2] == pytest.approx(-sunk_m, rel=1e-3)
    assert np.abs(scene.velocity("tool")).max() < 1e-3


def test_a_handle_that_is_too_stiff_for_the_proxy_is_warned_of():
    stiff = CouplingParameters(rotational_damping_Nms_per_rad=0.004)
    with pytest.warns(SceneWarning, match="rotational_damping.* holds at most 0.0033"):
        rest_on_a_slab(coupling=stiff)


def test_the_proxy_is_stated_before_the_run():
    _, rendering = rest_on_a_slab()
    assert rendering.proxy_gains.stiffness_N_per_m == pytest.approx(MASS / 2 / STEP**2)
    assert "drawn to a proxy with 5e+04 N/m" in repr(rendering)


def test_a_proxy_has_no_derivatives_and_says_what_to_take():
    scene, _ = rest_on_a_slab(PLANTS["continuous"])
    scene.start(tool=RigidTransform([0, 0, 0.015]))
    with pytest.raises(
        ValueError, match=r"body_of_proxy .*: take contact\.law: penalty"
    ):
        find_equilibrium(scene.diagram, scene.root)


def test_what_the_law_does_not_have_is_refused():
    slow = ContactParameters(law="constraint", query_rate_hz=500.0)
    with pytest.raises(SceneError, match="query_rate_hz does nothing"):
        rest_on_a_slab(contact=slow)
    with pytest.raises(SceneError, match=r"effects\.friction.*proxy has no friction"):
        rest_on_a_slab(effects=Effects(friction=FrictionParameters()))
