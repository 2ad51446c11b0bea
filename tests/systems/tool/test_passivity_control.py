"""The passivity control as a Drake system; its law has its own tests in the core."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import DiagramBuilder
from twin_check import check_twin

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.device.rendered_force_hold import RenderedForceHold
from drake_haptics.systems.tool.passivity_control import PassivityControl

PERIOD, MAX_B, MAX_BR, RESERVE = 1e-3, 20.0, 0.01, 0.1
GOOD = {
    "period_s": PERIOD,
    "max_damping_Ns_per_m": MAX_B,
    "max_rotational_damping_Nms_per_rad": MAX_BR,
    "reserve_J": RESERVE,
}


@pytest.fixture
def control():
    return PassivityControl(**GOOD)


class Port:
    """A control whose inputs are fixed, tick by tick."""

    def __init__(self, control):
        self.control = control
        self.context = control.CreateDefaultContext()

    def fix(self, *, asked=(0,) * 6, applied=(0,) * 6, X_WH=None, V_WH=(0,) * 6):
        """Fixes all inputs."""
        for port, value in [
            (self.control.GetInputPort("F_Ho_W_desired"), asked),
            (self.control.GetInputPort("F_Ho_W_rendered"), applied),
            (
                self.control.GetInputPort("X_WH"),
                pose_to_vector(X_WH or RigidTransform()),
            ),
            (self.control.GetInputPort("V_WH"), V_WH),
        ]:
            port.FixValue(self.context, np.asarray(value, float))

    def read(self):
        """Returns F_Ho_W_commanded and the balance."""
        return (
            self.control.GetOutputPort("F_Ho_W_commanded").Eval(self.context),
            self.control.GetOutputPort("energy_J").Eval(self.context)[0],
        )

    def update(self):
        """Ends a tick."""
        new = self.control.EvalUniquePeriodicDiscreteUpdate(self.context)
        self.context.SetDiscreteState(new.get_vector().CopyToVector())


def test_what_is_asked_goes_straight_through(control):
    """No sample of delay: only a hold on F_Ho_W_commanded closes the loop."""
    display = control.GetOutputPort("F_Ho_W_commanded").get_index()
    for i in range(control.num_input_ports()):
        assert control.HasDirectFeedthrough(i, display)


def test_its_state_is_what_linearization_accepts(control):
    # One discrete group, one period, no offset.
    assert control.IsDifferenceEquationSystem() == (True, PERIOD)
    assert control.CreateDefaultContext().get_discrete_state_vector().size() == 8


def test_it_starts_with_an_empty_balance_wherever_the_handle_is(control):
    port = Port(control)
    asked = [0.1, 0.2, 0.3, 1, 2, 3]
    port.fix(asked=asked, X_WH=RigidTransform([5, 6, 7]), V_WH=np.ones(6))
    shown, energy = port.read()
    np.testing.assert_array_equal(shown, asked)
    assert energy == 0.0


def test_the_balance_follows_the_work_of_what_was_applied(control):
    port = Port(control)
    at = [
        RigidTransform(RotationMatrix.MakeZRotation(0.01 * k), [1e-3 * k**2, 0, 2.0])
        for k in range(4)
    ]
    applied = np.array([0, 0, 0.05, -0.5, 3.0, 4.0])
    port.fix(X_WH=at[0])
    port.update()
    for k in (1, 2, 3):
        port.fix(applied=applied, X_WH=at[k])
        port.update()
        # Torque times angle and force times way, received with the other sign.
        expected = -(0.05 * 0.01 * k - 0.5 * 1e-3 * k**2)
        assert port.read()[1] == pytest.approx(expected, rel=1e-12)


def test_between_ticks_the_balance_is_up_to_date_and_counted_once(control):
    port = Port(control)
    port.fix()
    port.update()
    moved = {"applied": [0, 0, 0, 2.0, 0, 0], "X_WH": RigidTransform([1e-3, 0, 0])}
    V = np.array([0, 0, 0, 1.0, 0, 0])
    port.fix(**moved, V_WH=V)
    shown, energy = port.read()
    assert energy == pytest.approx(-2e-3)
    assert shown[3] == pytest.approx(-2e-3 / PERIOD)
    port.update()
    after, energy = port.read()
    assert energy == pytest.approx(-2e-3)
    np.testing.assert_array_equal(after, shown)


def test_what_the_device_did_not_show_is_not_counted(control):
    """The hold limits the wrench; the observer sees what it holds."""
    builder = DiagramBuilder()
    builder.AddSystem(control)
    hold = builder.AddSystem(RenderedForceHold(PERIOD, 5.0, 0.1))
    builder.Connect(
        control.GetOutputPort("F_Ho_W_commanded"), hold.GetInputPort("F_Ho_W_commanded")
    )
    builder.Connect(
        hold.GetOutputPort("F_Ho_W_rendered"), control.GetInputPort("F_Ho_W_rendered")
    )
    for port, name in [
        (control.GetInputPort("F_Ho_W_desired"), "F_Ho_W_desired"),
        (control.GetInputPort("X_WH"), "X_WH"),
        (control.GetInputPort("V_WH"), "V_WH"),
    ]:
        builder.ExportInput(port, name)
    builder.ExportOutput(control.GetOutputPort("energy_J"), "energy_J")
    loop = builder.Build()
    context = loop.CreateDefaultContext()
    loop.GetInputPort("F_Ho_W_desired").FixValue(context, [0, 0, 0, -50.0, 0, 0])
    loop.GetInputPort("V_WH").FixValue(context, np.zeros(6))
    for k in range(3):
        X_WH = RigidTransform([1e-3 * k, 0, 0])
        loop.GetInputPort("X_WH").FixValue(context, pose_to_vector(X_WH))
        new = loop.EvalUniquePeriodicDiscreteUpdate(context)
        context.get_mutable_discrete_state().SetFrom(new)
    energy = loop.GetOutputPort("energy_J").Eval(context)[0]
    assert energy == pytest.approx(5.0 * 2e-3)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("balance", "damped"),
    [(-5e-3, "in part"), (-10.0, "with all"), (1e-2, "not"), (0.11, "not, full")],
)
def test_derivatives_in_each_of_its_ways_are_those_of_the_law(
    control, seed, balance, damped
):
    rng = np.random.default_rng(seed)
    V_WH = np.concatenate([rng.normal(size=3), rng.uniform(0.4, 0.9, 3)])
    last = pose_to_vector(RigidTransform(RotationMatrix(), rng.normal(size=3)))
    turn = RotationMatrix.MakeXRotation(1e-2) @ RotationMatrix.MakeZRotation(2e-2)
    now = pose_to_vector(RigidTransform(turn, last[4:] + 1e-4 * rng.normal(size=3)))
    inputs = {
        "F_Ho_W_desired": rng.normal(size=6),
        "F_Ho_W_rendered": rng.normal(size=6) * [1e-3, 1e-3, 1e-3, 1, 1, 1],
        "X_WH": now,
        "V_WH": V_WH,
    }
    state = np.concatenate([[balance], last])
    slope = check_twin(control, inputs, state=state, step=1e-5, rtol=1e-8)
    shown, energy = slope[:6], slope[6]
    assert energy.any() == (damped != "not, full")
    assert shown[:, 6:19].any() == (damped == "in part")
    assert shown[:, 19:25].any() == (damped in {"in part", "with all"})


def test_two_contexts_know_nothing_of_each_other(control):
    first, second = Port(control), Port(control)
    for port in (first, second):
        port.fix()
        port.update()
    first.fix(applied=[0, 0, 0, 1, 0, 0], X_WH=RigidTransform([1e-3, 0, 0]))
    first.update()
    assert first.read()[1] == pytest.approx(-1e-3)
    assert second.read()[1] == 0.0


@pytest.mark.parametrize("name", GOOD)
@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_bad_values_are_refused(name, bad):
    with pytest.raises(ValueError, match=f"{name} must be finite and .*, is {bad:g}"):
        PassivityControl(**GOOD | {name: bad})
