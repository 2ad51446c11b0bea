"""There is one sample of delay in the loop: the hold's, and no other.

On a mass of 0.1 kg damped by 0.5 N·s/m at 1 kHz a spring is stable up to 1000.8 N/m
with the hold alone, and up to 333.8 N/m with one sample more (Gil et al. 2004:
K (T/2 + d T) < b). Which of the two our own systems are is an eigenvalue.
"""

import math

import pytest
from coupled_device import add_device_on_fixed_tool
from one_axis_device import make_one_axis_device
from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ZeroOrderHold

from drake_haptics._core import CouplingGains
from drake_haptics.analysis.sampled_linearization import linearize_sampled
from drake_haptics.analysis.sampled_wall import SampledWall, calc_largest_stiffness
from drake_haptics.analysis.stability_limit import calc_growth, find_stability_limit
from drake_haptics.systems.device.haptic_device import HapticDevice

PERIOD = 1e-3
MASS, DAMPING = 0.1, 0.5


def make_loop(stiffness, damping, *, late):
    builder = DiagramBuilder()
    backend = make_one_axis_device(MASS, DAMPING)
    device = HapticDevice(backend, period_s=PERIOD, max_force_N=1e9, max_torque_Nm=1e9)
    if late:
        device = LateDevice(device)
    gains = CouplingGains(stiffness, damping, 0.0, 0.0)
    add_device_on_fixed_tool(builder, device, gains, RigidTransform())
    return builder.Build()


class LateDevice(HapticDevice):
    """A device that shows what it was asked for one sample late."""

    def __init__(self, device):
        super(HapticDevice, self).__init__()
        builder = DiagramBuilder()
        builder.AddNamedSystem("device", device)
        hold = builder.AddNamedSystem("late", ZeroOrderHold(PERIOD, 6))
        builder.Connect(hold.get_output_port(), device.GetInputPort("F_Ho_W_commanded"))
        builder.ExportInput(hold.get_input_port(), "F_Ho_W_commanded")
        for name in ("X_WH", "V_WH", "F_Ho_W_rendered", "status"):
            builder.ExportOutput(device.GetOutputPort(name), name)
        builder.BuildInto(self)


def find_limit(damping, *, late):
    def growth(stiffness):
        diagram = make_loop(stiffness, damping, late=late)
        linear = linearize_sampled(diagram, diagram.CreateDefaultContext())
        return calc_growth(linear.eigenvalues())

    return find_stability_limit(growth, 500.0, lowest=10.0, highest=1e5).value


@pytest.mark.parametrize(("late", "expected"), [(False, 1000.83), (True, 333.80)])
def test_our_loop_has_the_hold_and_no_more(late, expected):
    assert find_limit(0.0, late=late) == pytest.approx(expected, rel=2e-4)


@pytest.mark.parametrize("damping", [0.5, 2.0])
def test_our_damped_loop_is_the_wall_that_sees_the_velocity(damping):
    wall = SampledWall(
        mass=MASS,
        damping=DAMPING,
        period_s=PERIOD,
        wall_damping=damping,
        true_velocity=True,
    )
    expected = calc_largest_stiffness(wall)
    assert math.isfinite(expected)
    assert find_limit(damping, late=False) == pytest.approx(expected, rel=2e-4)
