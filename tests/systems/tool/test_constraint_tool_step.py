"""The tool's step under constraints as a Drake system, on a cube over a plate."""

import numpy as np
import pytest
from mesh_samples import box
from press_tools import hull_mesh, make_tool
from pydrake.autodiffutils import ExtractGradient, InitializeAutoDiff
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from twin_check import differentiate

from drake_haptics._core import CouplingGains, RigidToolDynamics
from drake_haptics.analysis.equilibrium import find_equilibrium
from drake_haptics.analysis.sampled_linearization import linearize_sampled
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.tool.constraint_tool_step import ConstraintToolStep
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

PERIOD, MASS, SKIN, HALF = 1e-3, 0.1, 2e-4, 0.01
GAINS = CouplingGains(800.0, 2.0, 1.0, 0.004)
DYNAMICS = RigidToolDynamics(MASS, np.array([0.0, 0.0, 0.002]), 2e-5 * np.eye(3))
# So far below its rest on the plate's top, z = 0, the handle wants the tool.
PRESS = 1e-3
AT_REST = HALF + SKIN
REST = pose_to_vector(RigidTransform())
FREE = RigidTransform([0.0, 0.0, 0.05])
PRESSED = RigidTransform([0.0, 0.0, AT_REST - PRESS])


def pieces(size, at):
    return decompose(Mesh.from_arrays(*box(size, at), name="box")).core


CUBE = pieces([2 * HALF] * 3, [-HALF] * 3)
PLATE = pieces([0.2, 0.2, 0.02], [-0.1, -0.1, -0.02])


def make_step(X_WO=RigidTransform(), X_WT=FREE, **changes):  # noqa: B008
    arguments = {
        "tool": CUBE,
        "objects": [ContactObject("plate", PLATE, X_WO)],
        "skin_m": [SKIN],
        "dynamics": DYNAMICS,
        "gains": GAINS,
        "X_HT": RigidTransform(),
        "X_WT": X_WT,
        "period_s": PERIOD,
    }
    return ConstraintToolStep(**{**arguments, **changes})


def simulate(step, X_WH, **inputs):
    """A simulator with a handle at rest, and other inputs fixed."""
    simulator = Simulator(step)
    context = simulator.get_mutable_context()
    given = {"X_WH": pose_to_vector(X_WH), "V_WH": np.zeros(6), **inputs}
    for name, value in given.items():
        step.GetInputPort(name).FixValue(context, value)
    return simulator


def advance(simulator, ticks):
    """Advances by ticks; half a tick less, so that round-off decides nothing."""
    start_s = round(simulator.get_context().get_time() / PERIOD) * PERIOD
    simulator.AdvanceTo(start_s + (ticks - 0.5) * PERIOD)
    return simulator.get_context()


def read(step, context, name):
    return step.GetOutputPort(name).Eval(context)


def rest_pressed(step=None, **inputs):
    step = step or make_step()
    simulator = simulate(step, PRESSED, **inputs)
    return step, simulator, advance(simulator, 400)


def test_its_state_is_one_group_and_one_period():
    step = make_step()
    assert step.IsDifferenceEquationSystem() == (True, PERIOD)
    context = step.CreateDefaultContext()
    np.testing.assert_array_equal(
        context.get_discrete_state_vector().value(),
        [*pose_to_vector(FREE), *np.zeros(6)],
    )


def test_apart_from_all_it_is_coupling_and_tool():
    X_WH = RigidTransform([0.003, -0.002, 0.055])
    step = make_step()
    mine = simulate(step, X_WH)
    builder = DiagramBuilder()
    coupling = builder.AddSystem(VirtualCoupling(GAINS, RigidTransform()))
    tool = builder.AddSystem(HapticTool(DYNAMICS, PERIOD, ["coupling"], FREE))
    for name in ("X_WT", "V_WT"):
        builder.Connect(tool.GetOutputPort(name), coupling.GetInputPort(name))
    builder.Connect(
        coupling.GetOutputPort("wrench_model"), tool.GetInputPort("coupling")
    )
    for name in ("X_WH", "V_WH"):
        builder.ExportInput(coupling.GetInputPort(name), name)
    for name in ("wrench_model", "F_Ho_W_commanded"):
        builder.ExportOutput(coupling.GetOutputPort(name), name)
    for name in ("X_WT", "V_WT"):
        builder.ExportOutput(tool.GetOutputPort(name), name)
    theirs_system = builder.Build()
    theirs = simulate(theirs_system, X_WH)
    for _ in range(20):
        a, b = advance(mine, 1), advance(theirs, 1)
        for name in ("X_WT", "V_WT", "F_Ho_W_commanded"):
            np.testing.assert_allclose(
                read(step, a, name), read(theirs_system, b, name), atol=1e-12
            )
        np.testing.assert_allclose(
            read(step, a, "coupling"), read(theirs_system, b, "wrench_model")
        )
    assert np.abs(read(step, a, "V_WT")).max() > 1e-3


def test_pressed_it_rests_a_skin_away_and_is_felt_as_the_spring():
    step, _, context = rest_pressed()
    assert read(step, context, "X_WT")[6] == pytest.approx(AT_REST, abs=1e-7)
    np.testing.assert_allclose(read(step, context, "V_WT"), 0.0, atol=1e-7)
    F = read(step, context, "F_Ho_W_commanded")
    np.testing.assert_allclose(F[3:], [0, 0, 800.0 * PRESS], atol=1e-4)
    np.testing.assert_allclose(F[:3], 0.0, atol=1e-6)


def test_contacts_carry_what_the_coupling_presses_with():
    step, _, context = rest_pressed()
    contacts = read(step, context, "contacts")
    wrench = read(step, context, "contact_wrench")
    assert len(contacts) == len(wrench.lambda_N) >= 3
    assert wrench.lambda_N.min() >= 0.0
    np.testing.assert_allclose(
        contacts.nhat_BA_W, [[0, 0, 1]] * len(contacts), atol=1e-12
    )
    np.testing.assert_allclose(wrench.f_cluster_W.sum(axis=0)[2], 800.0 * PRESS, 1e-4)
    pull = read(step, context, "coupling")[:6]
    np.testing.assert_allclose(read(step, context, "F_To_W"), -pull, atol=1e-5)


def test_the_object_gets_the_reaction():
    # Beside the origin of the plate, which moves: its force has a moment there.
    X_WO = RigidTransform([0.03, -0.02, 0.0])
    step, _, context = rest_pressed(
        make_step(X_WO=None), X_WO_plate=pose_to_vector(X_WO), V_WO_plate=np.zeros(6)
    )
    F_T, F_O = read(step, context, "F_To_W"), read(step, context, "F_O_W")
    p_WTo = read(step, context, "X_WT")[4:]
    np.testing.assert_allclose(F_O[3:], -F_T[3:], rtol=1e-9)
    moment = F_T[:3] + np.cross(p_WTo - X_WO.translation(), F_T[3:])
    np.testing.assert_allclose(F_O[:3], -moment, atol=1e-6)
    assert np.abs(moment).max() > 0.01


def test_a_plate_that_rises_carries_the_tool():
    speed = 0.1
    step = make_step(X_WO=None, X_WT=RigidTransform([0, 0, AT_REST]))
    at = RigidTransform()
    simulator = simulate(
        step,
        PRESSED,
        X_WO_plate=pose_to_vector(at),
        V_WO_plate=np.array([0, 0, 0, 0, 0, speed]),
    )
    context = advance(simulator, 1)
    # All of the plate's way in the tick, whatever the coupling wants.
    assert read(step, context, "V_WT")[5] == pytest.approx(speed, rel=1e-2)


def test_the_slope_is_that_of_the_rows_alone():
    step, _, context = rest_pressed()
    model = read(step, context, "wrench_model")
    F, K, B = model[:6], model[6:42].reshape(6, 6), model[42:]
    np.testing.assert_array_equal(B, 0.0)
    np.testing.assert_array_equal(K, K.T)
    # Stiff against the plate and against tilting; along it and about z free.
    stiff, free = np.diag(K)[[0, 1, 5]], np.diag(K)[[2, 3, 4]]
    assert stiff[2] > 1e8 and stiff[:2].min() > 1e8 * HALF**2
    assert np.abs(free).max() < 1e-3
    # What the rows push with, once the tool has moved by what is left of its motion.
    delta = PERIOD * read(step, context, "V_WT")
    np.testing.assert_allclose(F - K @ delta, read(step, context, "F_To_W"), atol=1e-3)


def test_a_weight_rests_on_the_plate():
    weight = np.zeros(78)
    weight[5] = -MASS * 9.81
    weight[:3] = np.cross(DYNAMICS.p_TTcm, weight[3:6])
    step = make_step(wrench_names=["gravity"])
    simulator = simulate(step, RigidTransform([0, 0, AT_REST]), gravity=weight)
    context = advance(simulator, 400)
    F = read(step, context, "F_To_W")
    np.testing.assert_allclose(F[3:], [0, 0, MASS * 9.81], atol=1e-3)


def test_a_wrench_that_is_not_connected_counts_as_none():
    step = make_step(wrench_names=["gravity"])
    context = advance(simulate(step, FREE), 3)
    np.testing.assert_array_equal(read(step, context, "V_WT"), np.zeros(6))


def test_a_copy_of_a_context_goes_on_by_itself():
    step, _, context = rest_pressed()
    away = pose_to_vector(RigidTransform([0.002, 0.0, AT_REST - PRESS]))

    def go_on(copied, ticks):
        simulator = Simulator(step, copied)
        step.GetInputPort("X_WH").FixValue(simulator.get_mutable_context(), away)
        return advance(simulator, ticks).get_discrete_state_vector().value().copy()

    before = context.get_discrete_state_vector().value().copy()
    first = go_on(context.Clone(), 25)
    # Neither the original nor a second copy knows of the first.
    np.testing.assert_array_equal(context.get_discrete_state_vector().value(), before)
    second = go_on(context.Clone(), 25)
    np.testing.assert_array_equal(first, second)
    assert np.abs(first - before).max() > 1e-3


def test_gains_change_in_one_context_alone():
    step, simulator, context = rest_pressed()
    other = context.Clone()
    twice = CouplingGains(1600.0, 2.0, 1.0, 0.004)
    step.set_gains(simulator.get_mutable_context(), twice)
    context = advance(simulator, 100)
    assert step.get_gains(context) == twice
    F = read(step, context, "F_Ho_W_commanded")
    np.testing.assert_allclose(F[5], 1600.0 * PRESS, rtol=1e-4)
    assert step.get_gains(other) == GAINS
    np.testing.assert_allclose(
        read(step, other, "F_Ho_W_commanded")[5], 800.0 * PRESS, rtol=1e-4
    )
    with pytest.raises(TypeError, match="must be CouplingGains"):
        step.set_gains(simulator.get_mutable_context(), 3.0)


def spike(length):
    """A pyramid whose tip is that far below its origin."""
    base = np.array([[0.01, 0, 0], [-0.005, 0.008, 0], [-0.005, -0.009, 0]])
    return make_tool(hull_mesh([*base, [0, 0, -length]]), [[0, 0, -1]]).core


def poles(mass, stiffness, damping, *, wall=0.0, tip=0.0):
    """Those of a mass on a spring and damper by implicit steps of a tick, by hand.

    m ξ/h² + c ξ/h + k ξ = m v/h - k e, x⁺ = e + ξ, v⁺ = ξ/h: `wall` holds ξ without
    a memory of e, `tip` is stiffness that the step takes where it begins.
    """
    A = mass / PERIOD**2 + damping / PERIOD + stiffness + wall
    inertia = mass / (PERIOD**2 * A)
    return np.roots([1.0, -(1.0 - (stiffness + tip) / A + inertia), inertia])


def test_a_spike_on_a_plane_has_the_poles_of_one_axis_each():
    length, inertia, hold, back = 0.03, 2e-5, 1e9, 1e7
    dynamics = RigidToolDynamics(MASS, np.zeros(3), inertia * np.eye(3))
    at = np.array([0.013, 0.007, length + SKIN])
    step = make_step(tool=spike(length), dynamics=dynamics, X_WT=RigidTransform(at))
    handle = RigidTransform(at - [0.0, 0.0, PRESS])
    context = simulate(step, handle).get_context()
    context = find_equilibrium(step, context, settle_s=1.0).context
    found = linearize_sampled(step, context)
    # It rests where the hard spring begins: away from the plane nothing holds it.
    assert found.kinks == ("step/z", "step/vz")
    K, C = GAINS.stiffness_N_per_m, GAINS.damping_Ns_per_m
    K_R = GAINS.rotational_stiffness_Nm_per_rad
    C_R = GAINS.rotational_damping_Nms_per_rad
    force = read(step, context, "F_To_W")[5]
    expected = [
        *poles(MASS, K + back, C, wall=hold),
        *np.tile(poles(MASS, K, C), 2),
        # Tilted, the tip that carries the force is beside the origin.
        *np.tile(poles(inertia, K_R, C_R, tip=-force * length), 2),
        *poles(inertia, K_R, C_R),
        0.0,  # the quaternion's length
    ]
    # Equal real parts differ by round-off, which must not mix up conjugates.
    np.testing.assert_allclose(
        *(
            sorted(
                np.asarray(x, dtype=complex), key=lambda z: (z.real.round(9), z.imag)
            )
            for x in (found.eigenvalues(), expected)
        ),
        atol=1e-7,
    )


def test_all_outputs_have_the_derivatives_of_doubles():
    rng = np.random.default_rng(3)
    step = make_step(X_WO=None, wrench_names=["gravity"])
    tilted = RigidTransform(RollPitchYaw(2e-3, -1e-3, 0.4), [0.0, 0.0, AT_REST])
    inputs = {
        "X_WH": pose_to_vector(PRESSED),
        "V_WH": 0.01 * rng.normal(size=6),
        "X_WO_plate": REST,
        "V_WO_plate": 1e-3 * rng.normal(size=6),
        "gravity": np.concatenate([0.1 * rng.normal(size=6), np.zeros(72)]),
    }
    state = np.concatenate([pose_to_vector(tilted), 1e-3 * rng.normal(size=6)])
    sizes = [len(vector) for vector in inputs.values()]

    def values_of(system):
        context = system.CreateDefaultContext()

        def values(z):
            parts = np.split(z, np.cumsum(sizes))
            for name, part in zip(inputs, parts, strict=False):
                system.GetInputPort(name).FixValue(context, part)
            context.SetDiscreteState(parts[-1])
            leaf = system.GetSubsystemByName("step")
            own = leaf.GetMyContextFromRoot(context)
            update = leaf.EvalUniquePeriodicDiscreteUpdate(own)
            names = ("F_Ho_W_commanded", "F_To_W", "F_O_W", "coupling")
            outputs = [read(system, context, name) for name in names]
            return np.concatenate([update.get_vector().CopyToVector(), *outputs])

        return values

    z = np.concatenate([*inputs.values(), state])
    found = values_of(step.ToAutoDiffXd())(InitializeAutoDiff(z).ravel())
    expected = differentiate(values_of(step), z, 1e-8)
    assert np.abs(values_of(step)(z)[19:25]).max() > 0.1  # it pushes
    gradient = ExtractGradient(found)
    size = np.maximum(np.abs(expected).max(axis=1), 1.0)[:, np.newaxis]
    np.testing.assert_allclose(gradient / size, expected / size, atol=1e-6)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"period_s": 0.0}, "period_s must be positive"),
        ({"objects": [], "skin_m": []}, "objects must not be empty"),
        (
            {"objects": [ContactObject("a", PLATE)] * 2, "skin_m": [1e-4] * 2},
            "several are a",
        ),
        ({"skin_m": [0.0]}, "skin_m"),
        ({"skin_m": [1e-4, 1e-4]}, "skin"),
    ],
)
def test_impossible_arguments_are_refused(changes, words):
    with pytest.raises(ValueError, match=words):
        make_step(**changes)


def test_with_friction_it_says_that_it_has_no_derivatives():
    step, _, context = rest_pressed(make_step(coefficient=[0.3]))
    with pytest.raises(ValueError, match=r"no derivatives.*effects\.friction"):
        linearize_sampled(step, context)
    with pytest.raises(ValueError, match=r"no derivatives.*effects\.friction"):
        step.ToAutoDiffXd()


def test_friction_holds_the_tool_and_the_plate_feels_it():
    side = RigidTransform([1e-4, 0.0, AT_REST - PRESS])
    step = make_step(X_WO=None, coefficient=[0.5])
    simulator = simulate(
        step,
        PRESSED,
        X_WO_plate=pose_to_vector(RigidTransform()),
        V_WO_plate=np.zeros(6),
    )
    advance(simulator, 400)
    step.GetInputPort("X_WH").FixValue(
        simulator.get_mutable_context(), pose_to_vector(side)
    )
    context = advance(simulator, 400)
    friction = read(step, context, "friction_force")
    f = friction.f_cluster_W.sum(axis=0)
    model = read(step, context, "friction_model")
    K = model[6:42].reshape(6, 6)
    # By the load of now, or what is left of that of the first touch.
    least = 0.5 * 800.0 * PRESS / 1e-4
    assert 0.999 * least <= K[3, 3] <= 2.001 * least
    # The coupling's spring and that of friction, one after another.
    np.testing.assert_allclose(f, [-1e-4 / (1 / 800 + 1 / K[3, 3]), 0, 0], atol=1e-4)
    assert not friction.sliding.any()
    F_T, F_O = read(step, context, "F_To_W"), read(step, context, "F_O_W")
    np.testing.assert_allclose(F_O[3:], -F_T[3:] - f, atol=1e-9)
    np.testing.assert_allclose(model[3:6], f, atol=1e-5)
    # The contact's slope has nothing of it.
    assert abs(read(step, context, "wrench_model")[6:42].reshape(6, 6)[3, 3]) < 1.0
