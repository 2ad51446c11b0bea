"""A wrench that comes whole ticks late."""

import numpy as np
import pytest
from diagram_parts import read_port
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import TrajectorySource
from pydrake.trajectories import PiecewisePolynomial
from twin_check import check_twin
from twin_rig import PERIOD, make_simulator

from drake_haptics.systems.arm.force_delay import ForceDelay
from drake_haptics.systems.device.rendered_force_hold import RenderedForceHold

TICKS = 20


@pytest.mark.parametrize("samples", [1, 2, 5])
def test_it_is_the_hold_shifted_by_as_many_ticks(samples):
    wrenches = np.random.default_rng(1).normal(size=(6, TICKS + 1))
    asked = PiecewisePolynomial.ZeroOrderHold(
        (np.arange(TICKS + 1) - 0.5) * PERIOD, wrenches
    )
    builder = DiagramBuilder()
    source = builder.AddSystem(TrajectorySource(asked))
    hold = builder.AddSystem(RenderedForceHold(PERIOD, 1e9, 1e9))
    delay = builder.AddSystem(ForceDelay(PERIOD, samples))
    builder.Connect(source.get_output_port(), hold.GetInputPort("F_Ho_W_commanded"))
    shown = hold.GetOutputPort("F_Ho_W_rendered")
    builder.Connect(shown, delay.get_input_port())
    simulator = make_simulator(builder.Build())
    ticks = []

    def note(root):
        for port in (shown, delay.get_output_port()):
            ticks.append(read_port(port, root).copy())

    # At the end of each tick, before the next one's updates.
    simulator.set_monitor(note)
    simulator.Initialize()
    ticks.clear()
    simulator.AdvanceTo(TICKS * PERIOD)
    held, delayed = np.array(ticks).reshape(TICKS, 2, 6).transpose(1, 2, 0)
    np.testing.assert_array_equal(held, wrenches[:, :TICKS])
    np.testing.assert_array_equal(delayed[:, samples:], held[:, :-samples])
    np.testing.assert_array_equal(delayed[:, :samples], 0.0)


def test_its_twin_passes_derivatives_on():
    rng = np.random.default_rng(2)
    jacobian = check_twin(
        ForceDelay(PERIOD, 3),
        {"F_Ho_W_rendered": rng.normal(size=6)},
        state=rng.normal(size=18),
    )
    # What leaves is the oldest sample; what comes in is the newest one next.
    assert np.array_equal(jacobian[:6, 18:24], np.eye(6))
    assert np.array_equal(jacobian[6:12, :6], np.eye(6))


@pytest.mark.parametrize("arguments", [(0.0, 1), (np.nan, 1), (1e-3, 0), (1e-3, -1)])
def test_what_is_no_delay_is_refused(arguments):
    with pytest.raises(ValueError, match="must be"):
        ForceDelay(*arguments)
