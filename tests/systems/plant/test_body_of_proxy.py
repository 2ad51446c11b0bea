"""Where a body goes, and what acts on its proxy as it acts on the body."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.systems.plant.body_of_proxy import BodyOfProxy

STEP = 0.01


def make_context(seed):
    """Returns the system, and a Context with random inputs but a handle."""
    rng = np.random.default_rng(seed)
    system = BodyOfProxy(STEP)
    context = system.CreateDefaultContext()
    for name in ("X_WT", "V_WT", "X_WP", "F_Po_W"):
        port = system.GetInputPort(name)
        value = rng.normal(size=port.size())
        if name.startswith("X"):
            value[:4] /= np.linalg.norm(value[:4])
        port.FixValue(context, value)
    return system, context


def read(system, context, port):
    return system.GetInputPort(port).Eval(context)


@pytest.mark.parametrize("seed", range(3))
def test_a_body_goes_on_turning_about_its_velocity(seed):
    system, context = make_context(seed)
    X_WT = vector_to_pose(read(system, context, "X_WT"))
    w, v = read(system, context, "V_WT").reshape(2, 3)
    found = vector_to_pose(system.GetOutputPort("X_WT_next").Eval(context))
    turn = Rotation.from_rotvec(STEP * w).as_matrix()
    np.testing.assert_allclose(
        found.rotation().matrix(), turn @ X_WT.rotation().matrix(), atol=1e-12
    )
    np.testing.assert_allclose(
        found.translation(), X_WT.translation() + STEP * v, atol=1e-12
    )


@pytest.mark.parametrize("is_held", [False, True])
def test_the_wrench_is_the_same_about_any_point(is_held):
    """The world's origin, about which both are taken."""
    system, context = make_context(7)
    wrench = read(system, context, "F_Po_W").copy()
    if is_held:
        model = np.arange(78.0)
        system.GetInputPort("handle").FixValue(context, model)
        wrench += model[:6]
    found = system.GetOutputPort("F_To_W").Eval(context)
    p_WPo = read(system, context, "X_WP")[4:]
    p_WTo = read(system, context, "X_WT")[4:]
    np.testing.assert_allclose(found[3:], wrench[3:])
    np.testing.assert_allclose(
        found[:3] + np.cross(p_WTo, found[3:]), wrench[:3] + np.cross(p_WPo, wrench[3:])
    )


@pytest.mark.parametrize("period_s", [0.0, -1e-3])
def test_a_period_that_is_not_positive_is_refused(period_s):
    with pytest.raises(ValueError, match="period_s must be positive and finite"):
        BodyOfProxy(period_s)
