"""The device port: its ports, and that it delays by one hold and no more."""

import numpy as np
import pytest
from coupled_device import add_device_on_fixed_tool
from pydrake.math import RigidTransform
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource, LogVectorOutput
from slider_device import DAMPING, MASS, PERIOD, make_device
from twin_check import check_twin

from drake_haptics import find_scene, load_scene
from drake_haptics._core import CouplingGains
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device


def test_it_shows_a_wrench_from_its_sample_until_the_next():
    device = make_device()
    builder = DiagramBuilder()
    builder.AddSystem(device)
    source = builder.AddSystem(ConstantVectorSource([0, 0, 0, 0, 0, 1.0]))
    builder.Connect(source.get_output_port(), device.GetInputPort("F_Ho_W_commanded"))
    diagram = builder.Build()
    simulator = Simulator(diagram)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", PERIOD)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    context = device.GetMyContextFromRoot(simulator.get_context())
    # The first sample is at 0 s, so the force acts over the whole of the first tick.
    simulator.AdvanceTo(PERIOD)
    rate = DAMPING / MASS
    speed = 1.0 / DAMPING * (1 - np.exp(-rate * PERIOD))
    velocity = device.GetOutputPort("V_WH").Eval(context)
    assert velocity[5] == pytest.approx(speed, rel=1e-7)
    # A new value is not shown before the next sample.
    source.get_mutable_source_value(
        source.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    ).SetFromVector([0, 0, 0, 0, 0, 100.0])
    applied = device.GetOutputPort("F_Ho_W_rendered")
    assert applied.Eval(context)[5] == 1.0
    simulator.AdvanceTo(1.5 * PERIOD)
    assert applied.Eval(context)[5] == 8.5
    assert device.GetOutputPort("status").Eval(context)[0] == 1.0


def growth(stiffness):
    """Returns how much the swing against a wall of this stiffness grew in 4 s."""
    builder = DiagramBuilder()
    device = make_device()
    gains = CouplingGains(stiffness, 0.0, 0.0, 0.0)
    add_device_on_fixed_tool(builder, device, gains, RigidTransform())
    log = LogVectorOutput(device.GetOutputPort("X_WH"), builder, PERIOD)
    diagram = builder.Build()
    simulator = Simulator(diagram)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", PERIOD)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    slider = device.GetSubsystemByName("slider")
    slider.GetMyMutableContextFromRoot(
        simulator.get_mutable_context()
    ).SetContinuousState([1e-4, 0.0])
    simulator.AdvanceTo(4.0)
    z = np.abs(log.FindLog(simulator.get_context()).data()[6])
    return z[-500:].max() / z[:500].max()


def test_a_wall_is_as_stiff_as_one_hold_of_delay_allows():
    # Exact limit of this mass and damper at 1 kHz: 1000.8 N/m with the hold alone,
    # 333.8 N/m with one more sample of delay.
    assert growth(900.0) < 0.6
    assert growth(1100.0) > 1.6


def test_its_twin_has_the_derivatives_of_hold_hand_and_arm():
    scene = load_scene(find_scene("torus_peg"))
    device = make_simulated_device(scene, make_hand_path(scene.hand.path))
    context = device.CreateDefaultContext()
    rng = np.random.default_rng(4)
    arm = context.get_continuous_state_vector().CopyToVector()
    check_twin(
        device,
        {"F_Ho_W_commanded": np.array([0.01, 0.02, -0.03, 1.0, 2.0, -1.0])},
        continuous=arm + 0.1 * rng.normal(size=arm.size),
        state=rng.normal(size=7),
        time_s=0.3,
        step=1e-3,
        rtol=1e-8,
    )
