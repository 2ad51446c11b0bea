"""A device that is simulated as a discrete plant hides the loop's instability.

A discrete plant steps velocity before position with the wall's force of the tick
(symplectic Euler), which stays stable up to K = (4 m + 2 b h - 2 B h) / h²: a hundred
times and more what a real device bears, that moves on while the wall is held. So a
simulated device must be a continuous plant, sampled.
"""

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LinearSystem, MatrixGain

from drake_haptics.analysis import linearize_sampled

MASS, PERIOD = 0.1, 1e-3
TRUE_LIMIT = 1000.83  # b = 0.5 N·s/m, B = 0


def make_device(time_step, damping):
    """A mass on a slider; state [x; v]."""
    plant = MultibodyPlant(time_step)
    handle = plant.AddRigidBody(
        "handle", SpatialInertia.SolidSphereWithMass(MASS, 0.02)
    )
    slider = PrismaticJoint(
        "slider", plant.world_frame(), handle.body_frame(), [1, 0, 0], damping=damping
    )
    plant.AddJoint(slider)
    if time_step:
        plant.SetUseSampledOutputPorts(False)
    plant.Finalize()
    return plant


def close(device, wall):
    builder = DiagramBuilder()
    builder.AddNamedSystem("device", device)
    builder.AddNamedSystem("wall", wall)
    builder.Connect(device.get_state_output_port(), wall.get_input_port())
    builder.Connect(
        wall.get_output_port(), device.get_applied_generalized_force_input_port()
    )
    return builder.Build()


def make_discrete(K, B, b):
    return close(make_device(PERIOD, b), MatrixGain([[-K, -B]]))


def make_true(K, B, b):
    wall = LinearSystem([[0]], [[-K, -B]], [[1]], np.zeros((1, 2)), PERIOD)
    return close(make_device(0.0, b), wall)


def calc_radius(diagram):
    return linearize_sampled(diagram, diagram.CreateDefaultContext()).spectral_radius()


def swings_up(diagram, duration_s=2.0):
    """Whether a simulated loop swings more in the end than in the beginning."""
    context = diagram.CreateDefaultContext()
    device = diagram.GetSubsystemByName("device")
    own = device.GetMyMutableContextFromRoot(context)
    device.SetPositionsAndVelocities(own, [1e-6, 0.0])
    simulator = Simulator(diagram, context)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", PERIOD / 10)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    sizes = []
    for t in np.arange(PERIOD, duration_s, PERIOD):
        simulator.AdvanceTo(t)
        sizes.append(abs(device.GetPositions(own)[0]))
    half = len(sizes) // 2
    return max(sizes[half:]) > max(sizes[:half])


@pytest.mark.parametrize(
    ("B", "b", "limit"),
    [(0.0, 0.0, 400e3), (1.0, 0.0, 398e3), (5.0, 0.0, 390e3), (0.0, 0.5, 401e3)],
)
def test_a_discrete_device_is_stable_up_to_absurd_stiffness(B, b, limit):
    assert limit == pytest.approx((4 * MASS + 2 * (b - B) * PERIOD) / PERIOD**2)
    # On the circle without damping: what grows at 1 + 1e-6 of the limit does not below.
    assert calc_radius(make_discrete((1 - 1e-6) * limit, B, b)) <= 1.0 + 1e-9
    assert calc_radius(make_discrete((1 + 1e-6) * limit, B, b)) > 1.0 + 1e-6


def test_the_same_device_in_continuous_time_is_not():
    assert calc_radius(make_true(0.9999 * TRUE_LIMIT, 0.0, 0.5)) < 1.0
    assert calc_radius(make_true(1.0001 * TRUE_LIMIT, 0.0, 0.5)) > 1.0
    # A hundred times over its limit the true loop flies apart; the discrete plant,
    # with which one would have chosen that stiffness, shows nothing.
    K = 100.0 * TRUE_LIMIT
    assert calc_radius(make_true(K, 0.0, 0.5)) > 1.2
    assert calc_radius(make_discrete(K, 0.0, 0.5)) < 1.0


def test_simulations_show_the_same():
    assert not swings_up(make_true(0.95 * TRUE_LIMIT, 0.0, 0.5))
    assert swings_up(make_true(1.05 * TRUE_LIMIT, 0.0, 0.5))
    assert not swings_up(make_discrete(100.0 * TRUE_LIMIT, 0.0, 0.5))
