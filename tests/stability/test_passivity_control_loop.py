"""The passivity control against loops that are not stable without it."""

import numpy as np
import pytest
from coupled_device import add_device_on_fixed_tool
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import AffineSystem, LogVectorOutput
from twin_rig import PERIOD, X_WH, make_arm, make_simulator

from drake_haptics._core import CouplingGains
from drake_haptics.bounds.sampled_spring import calc_stable_stiffness
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.framework.vector_ports import export_parts
from drake_haptics.systems.tool.passivity_control import PassivityControl

MASS, DAMPING, SPEED = 0.1, 0.5, 0.1
LIMIT = calc_stable_stiffness(DAMPING, 0.0, PERIOD)
IN_X = np.eye(6)[3]


def make_slider():
    """Returns a device backend: a mass with a damper that slides along x."""
    builder = DiagramBuilder()
    to_outputs = np.zeros((13, 2))
    to_outputs[4, 0] = to_outputs[10, 1] = 1.0
    body = builder.AddSystem(
        AffineSystem(
            A=np.array([[0.0, 1.0], [0.0, -DAMPING / MASS]]),
            B=np.vstack([np.zeros(6), IN_X / MASS]),
            f0=np.zeros(2),
            C=to_outputs,
            D=np.zeros((13, 6)),
            y0=np.eye(13)[0],
        )
    )
    body.configure_default_state([0.0, SPEED])
    builder.ExportInput(body.get_input_port(), "F_Ho_W_rendered")
    export_parts(builder, body.get_output_port(), {"X_WH": 7, "V_WH": 6})
    slider = Diagram()
    builder.BuildInto(slider)
    return slider


def make_control(max_damping, max_rotational_damping=0.0):
    return PassivityControl(
        period_s=PERIOD,
        max_damping_Ns_per_m=max_damping,
        max_rotational_damping_Nms_per_rad=max_rotational_damping,
        reserve_J=1.0,
    )


def run(backend, gains, X_WT, control, duration_s):
    """Returns logs over ticks: X_WH, V_WH, F_Ho_W_rendered and the balance."""
    builder = DiagramBuilder()
    device = HapticDevice(backend, period_s=PERIOD, max_force_N=1e9, max_torque_Nm=1e9)
    add_device_on_fixed_tool(builder, device, gains, X_WT, control)
    ports = [
        device.GetOutputPort("X_WH"),
        device.GetOutputPort("V_WH"),
        device.GetOutputPort("F_Ho_W_rendered"),
    ]
    if control is not None:
        ports.append(control.GetOutputPort("energy_J"))
    logs = [LogVectorOutput(port, builder, PERIOD) for port in ports]
    simulator = make_simulator(builder.Build())
    simulator.AdvanceTo(duration_s)
    return [log.FindLog(simulator.get_context()).data() for log in logs]


def slide(stiffness, control):
    """Returns the slider's way and the balance, on a spring, for a second."""
    gains = CouplingGains(stiffness, 0.0, 0.0, 0.0)
    logs = run(make_slider(), gains, RigidTransform(), control, 1.0)
    return logs[0][4], logs[2][3], logs[-1][0]


def calc_leak(stiffness):
    """Returns what half a swing gives: ½ K v² T² a tick, at most ½ K v0² T π/(2 ω)."""
    omega = np.sqrt(stiffness / MASS)
    return 0.5 * stiffness * SPEED**2 * PERIOD * np.pi / (2 * omega)


@pytest.mark.parametrize("stiffness", [2 * LIMIT, 5 * LIMIT])
def test_a_spring_beyond_the_limit_comes_to_rest(stiffness):
    x, _, _ = slide(stiffness, None)
    assert abs(x[-200:]).max() > 3 * abs(x[:200]).max()

    x, _, _ = slide(stiffness, make_control(20.0))
    # It never swings farther than its first energy and one leak let it, and dies away
    # as the device's own damper wants it.
    energy = 0.5 * MASS * SPEED**2 + calc_leak(stiffness)
    assert abs(x).max() <= np.sqrt(2 * energy / stiffness)
    decay = np.exp(-DAMPING / (2 * MASS) * 0.8)
    assert abs(x[-200:]).max() < 1.2 * decay * abs(x[:200]).max()


def test_the_port_gives_out_no_more_than_the_leak_of_half_a_swing():
    stiffness = 2 * LIMIT
    x, F, balance = slide(stiffness, make_control(20.0))
    # Force that was held since the last tick times way; the log shows it there.
    received = -np.cumsum(F[1:] * np.diff(x))
    leak = calc_leak(stiffness)
    assert -leak <= received.min() < 0
    np.testing.assert_allclose(balance[1:], received, atol=1e-12)

    x, F, _ = slide(stiffness, None)
    assert -np.sum(F[1:] * np.diff(x)) < -10 * leak


@pytest.mark.parametrize(("place", "factor"), [(0, 1.5), (0, 2.0), (2, 1.2)])
def test_an_arm_without_a_hand_comes_to_rest(place, factor):
    """In six axes: a coupling that is too stiff for the free simulated arm."""
    gains = [800.0, 2.0, 1.0, 0.004]
    gains[place] = factor * calc_stable_stiffness(0.0, gains[place + 1], PERIOD)
    X_WT = X_WH @ RigidTransform(RollPitchYaw(1e-4, 2e-4, 3e-4), [1e-5, 2e-5, 3e-5])

    def calc_growth(control):
        V_WH = run(make_arm(), CouplingGains(*gains), X_WT, control, 1.0)[1]
        speed = np.linalg.norm(V_WH, axis=0)
        return speed[-200:].max() / speed[200:400].max()

    assert calc_growth(make_control(20.0, 0.02)) < 0.5
    assert calc_growth(None) > 1.5
