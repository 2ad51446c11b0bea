"""The coupling system; its law has its own test (tests/core/tool)."""

import numpy as np
import pytest
from coupling_samples import BR, KR, X_HT, X_WH, B, K
from pydrake.common.eigen_geometry import AngleAxis
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from twin_check import check_twin

from drake_haptics._core import CouplingGains
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

AT_REST = np.zeros(6)


@pytest.fixture
def coupling():
    return VirtualCoupling(CouplingGains(K, B, KR, BR), X_HT)


def evaluate(coupling, X_WT, V_WH=AT_REST, V_WT=AT_REST):
    context = coupling.CreateDefaultContext()
    coupling.GetInputPort("X_WH").FixValue(context, pose_to_vector(X_WH))
    coupling.GetInputPort("V_WH").FixValue(context, V_WH)
    coupling.GetInputPort("X_WT").FixValue(context, pose_to_vector(X_WT))
    coupling.GetInputPort("V_WT").FixValue(context, V_WT)
    return (
        coupling.GetOutputPort("wrench_model").Eval(context),
        coupling.GetOutputPort("F_Ho_W_commanded").Eval(context),
    )


def test_it_has_no_state_and_no_delay(coupling):
    assert coupling.CreateDefaultContext().num_total_states() == 0
    assert coupling.HasDirectFeedthrough(0, 1)


@pytest.mark.parametrize(
    "bad",
    [
        RigidTransform([0.0, np.nan, 0.0]),
        RigidTransform([0.0, np.inf, 0.0]),
        RigidTransform(RollPitchYaw(np.nan, 0.0, 0.0), np.zeros(3)),
    ],
)
def test_a_pose_that_is_not_finite_is_refused(bad):
    with pytest.raises(ValueError, match=r"X_HT must be finite, .*(nan|inf)"):
        VirtualCoupling(CouplingGains(K, B, KR, BR), bad)


def test_the_handle_feels_the_reaction(coupling):
    pull = np.array([0.001, -0.002, 0.003])
    X_WT = X_WH @ X_HT
    X_WT.set_translation(X_WT.translation() + pull)
    model, display = evaluate(coupling, X_WT)
    np.testing.assert_allclose(model[3:6], -K * pull, atol=1e-10)
    np.testing.assert_allclose(display[3:], K * pull, atol=1e-10)
    # About the handle's origin the force has the lever of the grasp.
    lever = X_WH.rotation() @ X_HT.translation()
    np.testing.assert_allclose(display[:3], np.cross(lever, K * pull), atol=1e-10)


def test_a_change_of_any_input_is_seen(coupling):
    rest = evaluate(coupling, X_WH @ X_HT)[1]
    moving = np.array([0.1, 0, 0, 0, 0.2, 0])
    assert not np.allclose(evaluate(coupling, X_WH @ X_HT, V_WH=moving)[1], rest)
    assert not np.allclose(evaluate(coupling, X_WH @ X_HT, V_WT=moving)[1], rest)


@pytest.mark.parametrize(
    "angle", [0.0, 1e-9, 1e-6, 1e-3, 0.5, 2.0, np.pi - 1e-2, np.pi - 1e-4]
)
def test_its_twin_has_its_derivatives_however_far_it_is_twisted(coupling, angle):
    twist = RigidTransform(
        RotationMatrix(AngleAxis(angle, np.array([0.36, 0.48, -0.8]))),
        [0.01, -0.02, 0.03],
    )
    # Half a turn is as far as the spring goes: the steps must not pass it.
    room = np.pi - angle
    check_twin(
        coupling,
        {
            "X_WH": pose_to_vector(X_WH),
            "V_WH": np.array([0.1, 0.2, -0.3, 1.0, -2.0, 3.0]),
            "X_WT": pose_to_vector(X_WH @ X_HT @ twist),
            "V_WT": np.array([-0.4, 0.5, 0.6, -0.1, 0.2, 0.3]),
        },
        step=min(1e-3, 0.05 * room),
        rtol=1e-8,
    )


def test_derivatives_do_not_mind_the_length_of_a_quaternion(coupling):
    """A pose that is integrated or perturbed leaves the unit sphere."""
    jacobian = check_twin(
        coupling,
        {
            "X_WH": pose_to_vector(X_WH) * [1.1, 1.1, 1.1, 1.1, 1, 1, 1],
            "V_WH": AT_REST,
            "X_WT": -pose_to_vector(X_WH) * [0.9, 0.9, 0.9, 0.9, -1, -1, -1],
            "V_WT": AT_REST,
        },
    )
    # By the length itself no wrench changes.
    np.testing.assert_allclose(
        jacobian[:84, :4] @ pose_to_vector(X_WH)[:4], 0.0, atol=1e-11
    )


@pytest.mark.parametrize("speed", [1.0, -1.0])
@pytest.mark.parametrize("times", [0.8, 1.2, 20.0])
def test_its_twin_has_its_derivatives_where_it_yields(times, speed):
    force_N, torque_Nm = 8.5, 0.188
    coupling = VirtualCoupling(
        CouplingGains(K, B, KR, BR, force_N, torque_Nm), RigidTransform()
    )
    axis = np.array([0.36, 0.48, -0.8])
    there = RigidTransform(
        RotationMatrix(AngleAxis(times * torque_Nm / KR, axis)),
        times * force_N / K * axis,
    )
    check_twin(
        coupling,
        {
            "X_WH": pose_to_vector(there),
            "V_WH": 0.1 * speed * np.concatenate([axis, axis]),
            "X_WT": pose_to_vector(RigidTransform()),
            "V_WT": np.zeros(6),
        },
        step=1e-4,
        rtol=1e-6,
    )
