"""The implicit tool as a Drake system; its step has its own test in the core."""

import numpy as np
import pytest
from pydrake.autodiffutils import InitializeAutoDiff
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.analysis import Simulator
from twin_check import check_twin

from drake_haptics._core import RigidToolDynamics
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.tool.haptic_tool import HapticTool

PERIOD, MASS = 1e-3, 0.1
X_WT = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [1.0, 2.0, 3.0])


@pytest.fixture
def tool():
    dynamics = RigidToolDynamics(MASS, np.zeros(3), 2e-5 * np.eye(3))
    return HapticTool(dynamics, PERIOD, ["coupling", "contact"], X_WT)


def force_model(force, stiffness=0.0, damping=0.0):
    model = np.zeros(78)
    model[3:6] = force
    model[6:42] = np.diag([0, 0, 0, *[stiffness] * 3]).ravel()
    model[42:] = np.diag([0, 0, 0, *[damping] * 3]).ravel()
    return model


def velocity_after(tool, ticks, **inputs):
    simulator = Simulator(tool)
    for name, model in inputs.items():
        tool.GetInputPort(name).FixValue(simulator.get_mutable_context(), model)
    # Half a tick more, so that round-off does not decide about the last update.
    simulator.AdvanceTo((ticks - 0.5) * PERIOD)
    return tool.GetOutputPort("V_WT").Eval(simulator.get_context())


def test_its_state_is_what_linearization_accepts(tool):
    # One discrete group, one period, no offset.
    assert tool.IsDifferenceEquationSystem() == (True, PERIOD)
    assert tool.CreateDefaultContext().get_discrete_state_vector().size() == 13


def test_it_starts_at_rest_where_it_is_told(tool):
    context = tool.CreateDefaultContext()
    np.testing.assert_allclose(
        tool.GetOutputPort("X_WT").Eval(context), pose_to_vector(X_WT)
    )
    np.testing.assert_array_equal(tool.GetOutputPort("V_WT").Eval(context), np.zeros(6))


def test_without_wrenches_it_stays(tool):
    np.testing.assert_array_equal(velocity_after(tool, 5), np.zeros(6))


def test_a_force_accelerates_it(tool):
    force = np.array([0.0, 1.0, -2.0])
    V = velocity_after(tool, 4, coupling=force_model(force))
    np.testing.assert_allclose(V[3:], 4 * PERIOD * force / MASS, rtol=1e-12)
    np.testing.assert_allclose(V[:3], 0.0, atol=1e-15)


def test_wrenches_add(tool):
    V = velocity_after(
        tool,
        1,
        coupling=force_model([1.0, 0, 0], 500.0, 1.0),
        contact=force_model([0, 2.0, 0], 1500.0, 2.0),
    )
    # (M + h B + h² K) dV = h F, with the sums of both.
    mass = MASS + PERIOD * 3.0 + PERIOD**2 * 2000.0
    np.testing.assert_allclose(V[3:], PERIOD * np.array([1, 2, 0]) / mass, rtol=1e-12)


def test_a_period_must_be_positive():
    with pytest.raises(ValueError, match="period_s must be positive"):
        HapticTool(RigidToolDynamics(1, np.zeros(3), np.eye(3)), 0.0, [], X_WT)


@pytest.mark.parametrize("spin_rad_s", [0.0, 1e-3, 3.0, 2000.0])
def test_its_twin_has_the_derivatives_of_its_step(spin_rad_s):
    """From a turn of nothing to one of two radians in a tick."""
    rng = np.random.default_rng(11)
    dynamics = RigidToolDynamics(
        MASS, np.array([0.01, -0.02, 0.005]), np.diag([2e-5, 3e-5, 4e-5])
    )
    tool = HapticTool(dynamics, PERIOD, ["coupling", "contact"], X_WT)
    velocity = rng.normal(size=6)
    velocity[:3] *= spin_rad_s / np.linalg.norm(velocity[:3])
    wrenches = {name: rng.normal(size=78) for name in ("coupling", "contact")}
    for model in wrenches.values():
        model[6:42] *= 1e3
    if spin_rad_s == 0.0:
        # The tool stays where it is: the turn that is differentiated is zero.
        wrenches = {name: np.r_[np.zeros(6), w[6:]] for name, w in wrenches.items()}
        velocity[:] = 0.0
    check_twin(
        tool,
        wrenches,
        state=np.concatenate([pose_to_vector(X_WT), velocity]),
        step=1e-4,
    )


def test_an_open_input_of_its_twin_counts_as_zero(tool):
    twin = tool.ToAutoDiffXd()
    context = twin.CreateDefaultContext()
    seed = InitializeAutoDiff(force_model([0.0, 0.0, 2.0])).ravel()
    twin.GetInputPort("contact").FixValue(context, seed)
    state = twin.EvalUniquePeriodicDiscreteUpdate(context).get_vector()
    state = state.CopyToVector()
    assert state[12].value() == pytest.approx(2.0 * PERIOD / MASS)
    assert state[12].derivatives()[5] == pytest.approx(PERIOD / MASS)
