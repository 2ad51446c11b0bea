"""The exact linear map of a sampled system over one period."""

import json

import numpy as np
import pytest
from pydrake.symbolic import Variable, sin
from pydrake.systems.analysis import DiscreteTimeApproximation
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Linearize, LinearSystem, SymbolicVectorSystem
from scipy.linalg import expm
from wall_loop import MASS_KG, PERIOD, make_loop, make_mass, make_wall
from wall_motion import TABLE

from drake_haptics.analysis import linearize_sampled


def linearize(system, **options):
    return linearize_sampled(system, system.CreateDefaultContext(), **options)


def calc_largest_stiffness(**loop):
    """Stiffness where an eigenvalue leaves the unit circle, by bisection."""
    low, high = 100.0, 1e5
    while high - low > 1e-7 * high:
        middle = 0.5 * (low + high)
        stable = linearize(make_loop(middle, **loop)).spectral_radius() < 1.0
        low, high = (middle, high) if stable else (low, middle)
    return low


@pytest.mark.parametrize(("b", "B", "delay", "hand", "limit", "_"), TABLE)
def test_the_largest_stiffness_of_a_sampled_wall_is_known(b, B, delay, hand, limit, _):
    held = tuple(hand.values()) or (0.0, 0.0, 0.0)
    found = calc_largest_stiffness(damping=b, wall_damping=B, delay=delay, hand=held)
    assert found == pytest.approx(limit, rel=2e-5)


def test_it_is_drakes_own_pieces_put_together():
    K, B = 900.0, 2.0
    found = linearize(make_loop(K, B), output_port="x")
    mass, wall = make_mass(), make_wall(K, B)
    flow = DiscreteTimeApproximation(mass, PERIOD)
    update = Linearize(wall, _context_with_input(wall))
    A_cc, A_cf, H = flow.A(), flow.B(), update.C()
    A_dc, A_dd = update.B() @ np.eye(2), update.A()
    expected = np.block([[A_cc + A_cf @ H @ A_dc, A_cf @ H @ A_dd], [A_dc, A_dd]])
    np.testing.assert_allclose(found.A, expected, rtol=0, atol=1e-12 * K)
    np.testing.assert_array_equal(found.C, np.eye(2, 4))


def _context_with_input(system):
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, np.zeros(system.get_input_port().size()))
    return context


def test_an_input_acts_through_the_held_update():
    # u is read by the sampler at t; the mass is pushed by it over the whole period.
    builder = DiagramBuilder()
    mass = builder.AddNamedSystem("mass", make_mass(damping=0.0))
    sampler = LinearSystem([[0]], [[1]], [[1]], [[0]], PERIOD)
    builder.AddNamedSystem("sampler", sampler)
    builder.Connect(sampler.get_output_port(), mass.get_input_port())
    builder.ExportInput(sampler.get_input_port(), "force")
    builder.ExportOutput(mass.get_output_port(), "x")
    diagram = builder.Build()
    context = _context_with_input(diagram)
    found = linearize_sampled(diagram, context, input_port="force", output_port="x")
    T, m = PERIOD, MASS_KG
    np.testing.assert_allclose(found.B, [[T**2 / (2 * m)], [T / m], [1.0]], rtol=1e-12)
    np.testing.assert_array_equal(found.D, np.zeros((2, 1)))
    twin = found.to_linear_system()
    assert twin.time_period() == PERIOD
    np.testing.assert_array_equal(twin.A(), found.A)


def test_an_input_of_the_motion_is_held():
    mass = make_mass(damping=0.0)
    found = linearize_sampled(
        mass, _context_with_input(mass), period_s=0.25, input_port=0, output_port=0
    )
    T, m = 0.25, MASS_KG
    np.testing.assert_allclose(found.A, [[1, T], [0, 1]], atol=1e-14)
    np.testing.assert_allclose(found.B, [[T**2 / (2 * m)], [T / m]], rtol=1e-12)
    assert found.period_s == T


def test_two_discrete_groups_of_one_period():
    builder = DiagramBuilder()
    first = builder.AddNamedSystem(
        "first", LinearSystem([[0.5]], [[2]], [[3]], [[0]], 0.1)
    )
    second = builder.AddNamedSystem(
        "second", LinearSystem([[0.25]], [[5]], [[7]], [[0]], 0.1)
    )
    builder.Connect(first.get_output_port(), second.get_input_port())
    builder.Connect(second.get_output_port(), first.get_input_port())
    diagram = builder.Build()
    with pytest.raises(SystemExit):
        Linearize(diagram, diagram.CreateDefaultContext())
    found = linearize(diagram)
    np.testing.assert_allclose(found.A, [[0.5, 14], [15, 0.25]], rtol=1e-15)
    assert found.state_names == ("first/xd[0]", "second/xd[0]")


def test_the_slope_at_the_equilibrium_counts_not_at_zero():
    # A pendulum that hangs upside down, held there by a sampled torque.
    q, w, torque = Variable("q"), Variable("w"), Variable("torque")
    pendulum = SymbolicVectorSystem(
        state=[q, w], input=[torque], dynamics=[w, 9.0 * sin(q) + torque], output=[q]
    )
    builder = DiagramBuilder()
    builder.AddNamedSystem("pendulum", pendulum)
    hold = builder.AddSystem(LinearSystem([[0]], [[-4.0]], [[1]], [[0]], 0.01))
    builder.Connect(pendulum.get_output_port(), hold.get_input_port())
    builder.Connect(hold.get_output_port(), pendulum.get_input_port())
    diagram = builder.Build()
    # 9 sin q = 4 q, by Newton.
    angle = 2.0
    for _ in range(30):
        angle -= (9 * np.sin(angle) - 4 * angle) / (9 * np.cos(angle) - 4)
    context = diagram.CreateDefaultContext()
    context.SetContinuousState([angle, 0.0])
    context.SetDiscreteState(0, [-4.0 * angle])
    found = linearize_sampled(diagram, context)
    slope, T = -9 * np.cos(angle), 0.01
    r = np.sqrt(slope)
    flow = np.array(
        [[np.cos(r * T), np.sin(r * T) / r], [-r * np.sin(r * T), np.cos(r * T)]]
    )
    push = np.array([(1 - np.cos(r * T)) / slope, np.sin(r * T) / r])
    expected = np.zeros((3, 3))
    expected[:2, :2] = flow
    expected[:2, 0] -= 4.0 * push
    expected[2, 0] = -4.0
    np.testing.assert_allclose(found.A, expected, atol=1e-13)
    assert found.equilibrium_residual < 1e-14


def test_the_users_context_stays_as_it_is():
    loop = make_loop(900.0)
    context = loop.CreateDefaultContext()
    context.SetTime(3.0)
    linearize_sampled(loop, context)
    assert context.get_time() == 3.0
    assert not np.any(context.get_continuous_state_vector().CopyToVector())


def test_eigenvalues_come_largest_first_and_go_to_json():
    found = linearize(make_loop(900.0, 2.0))
    magnitudes = np.abs(found.eigenvalues())
    assert list(magnitudes) == sorted(magnitudes, reverse=True)
    assert found.spectral_radius() == magnitudes[0]
    stored = json.loads(json.dumps(found.to_dict()))
    np.testing.assert_array_equal(stored["A"], found.A)
    assert stored["eigenvalues"][0][0] == found.eigenvalues()[0].real


def test_update_and_motion_make_the_map():
    found = linearize(make_loop(900.0, 2.0, delay=1))
    motion = expm(found.rates * PERIOD)
    np.testing.assert_allclose(motion @ found.update, found.A, rtol=1e-14)
    # The update moves nothing; the motion changes no memory.
    np.testing.assert_array_equal(found.update[:2], np.eye(2, 5))
    assert not found.rates[2:].any()
