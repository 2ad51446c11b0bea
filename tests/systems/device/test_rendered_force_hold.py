"""The last gate before a device."""

import numpy as np
import pytest
from pydrake.autodiffutils import InitializeAutoDiff
from pydrake.math import RigidTransform
from twin_check import check_twin

from drake_haptics._core import CouplingGains
from drake_haptics.systems.device.rendered_force_hold import (
    LIMITED,
    NOT_FINITE,
    SHOWN_AS_ASKED,
    RenderedForceHold,
)
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

MAX_FORCE, MAX_TORQUE = 8.5, 0.188


def sample(wrench, coupled_motions=None):
    """Returns F_Ho_W_rendered and status after one tick."""
    hold = RenderedForceHold(1e-3, MAX_FORCE, MAX_TORQUE)
    context = hold.CreateDefaultContext()
    hold.GetInputPort("F_Ho_W_commanded").FixValue(context, np.array(wrench, float))
    if coupled_motions is not None:
        hold.GetInputPort("coupled_motions").FixValue(context, coupled_motions)
    context.SetDiscreteState(
        hold.EvalUniquePeriodicDiscreteUpdate(context).get_vector().CopyToVector()
    )
    return (
        hold.GetOutputPort("F_Ho_W_rendered").Eval(context),
        hold.GetOutputPort("status").Eval(context)[0],
    )


def test_a_coupling_is_computed_and_limited_in_one_call():
    """Bit for bit as its wrench; the other input is not read then."""
    rng = np.random.default_rng(3)
    coupling = VirtualCoupling(
        CouplingGains(200.0, 1.0, 0.5, 1e-3), RigidTransform([0.01, -0.02, 0.03])
    )
    for size in (1e-3, 1.0):
        motions = coupling.CreateDefaultContext()
        for name in ("X_WH", "X_WT"):
            pose = np.concatenate([[1.0, 0, 0, 0], size * rng.normal(size=3)])
            coupling.GetInputPort(name).FixValue(motions, pose)
        for name in ("V_WH", "V_WT"):
            coupling.GetInputPort(name).FixValue(motions, size * rng.normal(size=6))
        wrench = coupling.GetOutputPort("F_Ho_W_commanded").Eval(motions)
        joined = coupling.GetOutputPort("motions_and_gains").Eval(motions)
        expected, status = sample(wrench)
        found, same = sample(np.full(6, np.nan), joined)
        np.testing.assert_array_equal(found, expected)
        assert same == status == (LIMITED if size == 1.0 else SHOWN_AS_ASKED)


def test_within_the_limits_it_shows_what_is_asked():
    wrench = [0.05, -0.05, 0.1, 3.0, -4.0, 5.0]
    applied, status = sample(wrench)
    np.testing.assert_array_equal(applied, wrench)
    assert status == SHOWN_AS_ASKED


@pytest.mark.parametrize("size", [10.0, 1e3, 1e160, 1e307])
def test_beyond_them_it_keeps_the_direction(size):
    applied, status = sample(size * np.array([1.0, 1.0, 0.0, 10.0, 0.0, -10.0]))
    assert status == LIMITED
    np.testing.assert_allclose(
        applied[:3], MAX_TORQUE * np.array([1, 1, 0]) / np.sqrt(2), rtol=1e-12
    )
    assert np.linalg.norm(applied[3:]) == pytest.approx(MAX_FORCE)
    np.testing.assert_allclose(applied[3], -applied[5])


def test_a_torque_over_its_limit_leaves_the_force():
    applied, status = sample([1.0, 0.0, 0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(applied, [MAX_TORQUE, 0, 0, 1, 2, 3])
    assert status == LIMITED


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("entry", range(6))
def test_what_is_not_finite_is_shown_as_nothing(value, entry):
    wrench = np.ones(6)
    wrench[entry] = value
    applied, status = sample(wrench)
    np.testing.assert_array_equal(applied, np.zeros(6))
    assert status == NOT_FINITE


@pytest.mark.parametrize(
    "arguments",
    [
        (0.0, 1.0, 1.0),
        (-1.0, 1.0, 1.0),
        (np.nan, 1.0, 1.0),
        (1e-3, -1.0, 1.0),
        (1e-3, np.inf, 1.0),
        (1e-3, 1.0, np.nan),
    ],
)
def test_impossible_limits_are_refused(arguments):
    with pytest.raises(ValueError):
        RenderedForceHold(*arguments)


@pytest.mark.parametrize("torque", [0.05, 1.0, 1e150], ids="{:g} N·m".format)
@pytest.mark.parametrize("force", [0.0, 2.0, 40.0], ids="{:g} N".format)
def test_its_twin_has_its_derivatives_within_the_limits_and_beyond(torque, force):
    hold = RenderedForceHold(1e-3, MAX_FORCE, MAX_TORQUE)
    direction = np.array([2.0, -1.0, 2.0]) / 3.0
    wrench = np.concatenate([torque * direction, force * direction])
    jacobian = check_twin(
        hold,
        {"F_Ho_W_commanded": wrench},
        state=np.arange(7.0),
        step=1e-3 * min(torque, 1),
    )
    # What is shown is of this sample alone, and limits keep the direction.
    update = jacobian[7:]
    assert not update[:, 6:].any()
    assert np.abs(update[3:6, 3:6] @ direction).max() == pytest.approx(
        2 / 3 if force <= MAX_FORCE else 0.0, abs=1e-12
    )


def test_what_is_not_finite_has_no_derivatives_that_are_not():
    twin = RenderedForceHold(1e-3, MAX_FORCE, MAX_TORQUE).ToAutoDiffXd()
    context = twin.CreateDefaultContext()
    asked = np.array([0.0, 0.0, 0.0, np.inf, np.nan, 1.0])
    commanded = twin.GetInputPort("F_Ho_W_commanded")
    commanded.FixValue(context, InitializeAutoDiff(asked).ravel())
    state = twin.EvalUniquePeriodicDiscreteUpdate(context).get_vector()
    for entry, value in zip(
        state.CopyToVector(), [0.0] * 6 + [NOT_FINITE], strict=True
    ):
        assert entry.value() == value
        assert not entry.derivatives().any()
