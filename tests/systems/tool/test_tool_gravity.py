"""The weight of the tool."""

import numpy as np
import pytest
from diagram_parts import read_output
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from twin_check import check_twin

from drake_haptics._core import RigidToolDynamics
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.tool_gravity import ToolGravity

MASS, P_TTCM = 0.1, np.array([0.01, -0.02, 0.05])
G = 9.81


def wrench_model(gravity, X_WT):
    context = gravity.CreateDefaultContext()
    gravity.GetInputPort("X_WT").FixValue(context, pose_to_vector(X_WT))
    return gravity.GetOutputPort("wrench_model").Eval(context)


def random_pose(seed):
    rng = np.random.default_rng(seed)
    return RigidTransform(RollPitchYaw(rng.uniform(-3, 3, 3)), rng.normal(size=3))


@pytest.mark.parametrize("seed", range(5))
def test_it_is_a_force_at_the_center_of_mass(seed):
    X_WT = random_pose(seed)
    acceleration = np.random.default_rng(seed).normal(size=3)
    gravity = ToolGravity(mass_kg=MASS, p_TTcm=P_TTCM, gravity_m_per_s2=acceleration)
    model = wrench_model(gravity, X_WT)
    arm = X_WT.rotation().matrix() @ P_TTCM
    np.testing.assert_allclose(model[:3], np.cross(arm, MASS * acceleration))
    np.testing.assert_allclose(model[3:6], MASS * acceleration)
    assert not model[6:].any()


@pytest.mark.parametrize("seed", range(5))
def test_its_derivatives_are_those_of_the_wrench(seed):
    gravity = ToolGravity(mass_kg=MASS, p_TTcm=P_TTCM)
    slope = check_twin(gravity, {"X_WT": pose_to_vector(random_pose(seed))})
    assert np.abs(slope[:3, :4]).max() > 0.01


@pytest.mark.parametrize("seed", range(5))
def test_it_is_the_slope_of_the_potential(seed):
    X_WT = random_pose(seed)
    F = wrench_model(ToolGravity(mass_kg=MASS, p_TTcm=P_TTCM), X_WT)[:6]
    step = 1e-6

    def height(turn, shift):
        R = RotationMatrix(RollPitchYaw(turn)) @ X_WT.rotation()
        return (R @ P_TTCM + X_WT.translation() + shift)[2]

    for i, axis in enumerate(np.eye(3) * step):
        turned = height(axis, 0 * axis) - height(-axis, 0 * axis)
        moved = height(0 * axis, axis) - height(0 * axis, -axis)
        assert F[i] == pytest.approx(-MASS * G * turned / (2 * step), abs=1e-8)
        assert F[3 + i] == pytest.approx(-MASS * G * moved / (2 * step), abs=1e-8)


def test_a_free_tool_falls_without_turning():
    """Its center of mass falls with g, wherever its origin is; it keeps its turn."""
    X_WT = random_pose(7)
    builder = DiagramBuilder()
    tool = builder.AddSystem(
        HapticTool(
            RigidToolDynamics(MASS, P_TTCM, 2e-5 * np.eye(3)), 1e-3, ["gravity"], X_WT
        )
    )
    gravity = builder.AddSystem(ToolGravity(mass_kg=MASS, p_TTcm=P_TTCM))
    builder.Connect(tool.GetOutputPort("X_WT"), gravity.GetInputPort("X_WT"))
    builder.Connect(gravity.GetOutputPort("wrench_model"), tool.GetInputPort("gravity"))
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(0.0995)
    V = read_output(tool, "V_WT", simulator.get_context())
    np.testing.assert_allclose(V, [0, 0, 0, 0, 0, -0.1 * G], atol=1e-9)


@pytest.mark.parametrize(
    ("bad", "named"),
    [
        ({"mass_kg": 0.0}, "mass_kg must be positive and finite, is 0"),
        ({"mass_kg": np.nan}, "mass_kg"),
        ({"mass_kg": np.inf}, "mass_kg"),
        ({"p_TTcm": [0, 0]}, "p_TTcm must be three finite numbers"),
        ({"p_TTcm": [0, 0, np.nan]}, "p_TTcm"),
        ({"gravity_m_per_s2": [0, 0, np.inf]}, "gravity_m_per_s2"),
        ({"gravity_m_per_s2": 9.81}, "gravity_m_per_s2"),
    ],
)
def test_bad_values_are_refused(bad, named):
    with pytest.raises(ValueError, match=named):
        ToolGravity(**{"mass_kg": MASS, "p_TTcm": P_TTCM} | bad)
