"""The sampled wall's matrix, against motions integrated without it."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from drake_haptics.analysis.sampled_wall import (
    SampledWall,
    calc_largest_delay,
    calc_largest_stiffness,
)
from drake_haptics.passivity_bounds import calc_stable_delay, calc_stable_stiffness

T = 1e-3
NO_HAND = {}
HAND = {"hand_mass": 0.2, "hand_damping": 5.0, "hand_stiffness": 300.0}
# b, B, periods of delay, hand, K by eigenvalues and K by simulation, N/m: figures of
# an earlier study, of a mass of 0.1 kg at 1 kHz.
TABLE = [
    (0.5, 0.0, 0, NO_HAND, 1000.83, 1000.89),
    (0.5, 0.0, 1, NO_HAND, 333.80, 333.81),
    (0.5, 2.0, 0, NO_HAND, 4905.3, 4905.6),
    (0.5, 2.0, 1, NO_HAND, 1632.0, 1632.1),
    (0.5, 20.0, 0, NO_HAND, 33591.0, 33593.0),
    (0.5, 0.0, 1, HAND, 3686.8, 3687.0),
    (0.5, 2.0, 1, HAND, 4988.0, 4988.3),
]


def make_wall(b, B, delay, hand, **more):
    return SampledWall(0.1, b, T, wall_damping=B, delay_s=delay * T, **hand, **more)


def integrate(wall, ticks, parts):
    """Integrates x and v numerically, a period in `parts` at whose ends forces change.

    Returns:
        x, v and the x of the sample before, at each tick, (ticks, 3).
    """
    m = wall.mass + wall.hand_mass
    late = round(wall.delay_s / wall.period_s * parts)
    assert late == pytest.approx(wall.delay_s / wall.period_s * parts)
    x, v, last = 1e-3, 0.02, 1.1e-3
    forces, found = {}, []
    for part in range(ticks * parts):
        if part % parts == 0:
            speed = v if wall.true_velocity else (x - last) / wall.period_s
            forces[part + late] = -(wall.stiffness * x + wall.wall_damping * speed)
            found.append((x, v, last))
            last = x
        shown = forces.get(max((k for k in forces if k <= part), default=-1), 0.0)

        def rate(_, y, shown=shown):
            damping = (wall.damping + wall.hand_damping) * y[1]
            return y[1], (shown - damping - wall.hand_stiffness * y[0]) / m

        y = solve_ivp(
            rate, (0, wall.period_s / parts), (x, v), "DOP853", rtol=1e-12, atol=1e-15
        ).y[:, -1]
        x, v = float(y[0]), float(y[1])
    return np.array(found)


@pytest.mark.parametrize("hand", [NO_HAND, HAND], ids=["free", "held"])
@pytest.mark.parametrize("true_velocity", [False, True])
@pytest.mark.parametrize("delay", [0.0, 1.0, 0.4, 2.6])
def test_the_matrix_moves_as_an_integrator_does(hand, true_velocity, delay):
    wall = make_wall(
        0.5, 20.0, delay, hand, stiffness=2000.0, true_velocity=true_velocity
    )
    expected = integrate(wall, 12, 5)
    A = wall.make_step_matrix()
    z = np.zeros(len(A))
    z[:3] = expected[0]
    scale = np.abs(expected).max(axis=0)
    for row in expected:
        assert z[:3] / scale == pytest.approx(row / scale, abs=1e-10)
        z = A @ z


def measure_growth(wall, ticks):
    """Simulates by the roots of m r² + c r + k, and returns the late over the early."""
    m = wall.mass + wall.hand_mass
    c, k = wall.damping + wall.hand_damping, wall.hand_stiffness
    root = cmath.sqrt(c * c - 4 * m * k)
    r1, r2 = (-c + root) / (2 * m), (-c - root) / (2 * m)
    e1, e2 = cmath.exp(r1 * T), cmath.exp(r2 * T)
    x, v, last = 1e-3, 0.0, 1e-3
    waiting = [0.0] * round(wall.delay_s / T)
    speeds = np.empty(ticks)
    for i in range(ticks):
        force = -(wall.stiffness * x + wall.wall_damping * (x - last) / T)
        waiting.append(force)
        force = waiting.pop(0)
        last = x
        if k > 0.0:
            # About the rest position under this force.
            rest = force / k
            a2 = (v - r1 * (x - rest)) / (r2 - r1)
            a1 = x - rest - a2
            x, v = (rest + a1 * e1 + a2 * e2).real, (a1 * r1 * e1 + a2 * r2 * e2).real
        else:
            # About the final speed under this force.
            speed, decay = force / c, math.exp(-c * T / m)
            x += speed * T + (v - speed) * (1 - decay) * m / c
            v = speed + (v - speed) * decay
        speeds[i] = abs(v)
    return speeds[-ticks // 10 :].max() / speeds[ticks // 5 : 3 * ticks // 10].max()


@pytest.mark.parametrize(("b", "B", "delay", "hand", "eigen", "simulated"), TABLE)
def test_the_stiffest_wall_is_that_of_the_table_and_of_a_simulation(
    b, B, delay, hand, eigen, simulated
):
    wall = make_wall(b, B, delay, hand)
    K = calc_largest_stiffness(wall)
    assert K == pytest.approx(eigen, rel=2e-5)
    assert K == pytest.approx(simulated, rel=1e-3)
    # Motions die just below, and grow just above.
    assert measure_growth(replace(wall, stiffness=0.999 * K), 20000) < 0.99
    assert measure_growth(replace(wall, stiffness=1.001 * K), 20000) > 1.01


def make_random_walls(count):
    random = np.random.default_rng(0)
    for _ in range(count):
        hand = {
            "hand_mass": 10 ** random.uniform(-2, 0),
            "hand_damping": 10 ** random.uniform(-1, 1.5),
            "hand_stiffness": 10 ** random.uniform(1, 4),
        }
        yield make_wall(
            b=10 ** random.uniform(-3, 2) * (random.random() < 0.8),
            B=10 ** random.uniform(-2, 2.3) * (random.random() < 0.8),
            delay=random.uniform(0, 4) * (random.random() < 0.7),
            hand=hand if random.random() < 0.5 else {},
            true_velocity=random.random() < 0.3,
        )


def test_no_wall_is_stable_again_beyond_its_limit():
    limited = 0
    for wall in make_random_walls(150):
        K = calc_largest_stiffness(wall)
        limited += K > 0
        below = np.geomspace(1e-3, 0.999, 20) * K if K else []
        above = np.geomspace(1.001, 1e3, 30) * K if K else np.geomspace(0.1, 1e6, 30)
        radius = [replace(wall, stiffness=k).calc_spectral_radius() for k in below]
        assert max(radius, default=0.0) < 1.0, wall
        radius = [replace(wall, stiffness=k).calc_spectral_radius() for k in above]
        assert min(radius) > 1.0, wall
    assert limited > 100


def test_a_true_velocity_is_a_half_period_younger():
    """The backward difference is the speed of half a period ago."""
    B, b = 2.0, 0.5
    true = calc_largest_stiffness(make_wall(b, B, 0, {}, true_velocity=True))
    backward = calc_largest_stiffness(make_wall(b, B, 0, {}))
    law = calc_stable_stiffness(b, B, T)
    assert backward < true == pytest.approx(law, rel=0.02)


@pytest.mark.parametrize("delay", [0.0, 1e-4, 1e-3, 2.7e-3])
def test_the_largest_delay_is_where_the_stiffness_is_the_largest(delay):
    wall = make_wall(0.5, 2.0, delay / T, HAND)
    wall = replace(wall, stiffness=calc_largest_stiffness(wall))
    assert calc_largest_delay(wall) == pytest.approx(delay, rel=1e-6, abs=1e-9)
    assert wall.calc_spectral_radius() == pytest.approx(1.0, abs=1e-9)


def test_the_largest_delay_follows_the_linear_law():
    wall = SampledWall(0.1, 0.5, T, stiffness=200.0, wall_damping=0.2)
    law = calc_stable_delay(200.0, 0.5, 0.2, T)
    assert law == pytest.approx(3e-3)
    assert calc_largest_delay(wall) == pytest.approx(law, rel=0.03)


def test_a_stiff_wall_bears_no_delay_and_a_soft_one_in_a_hand_any():
    assert calc_largest_delay(make_wall(0.5, 0.0, 0, {}, stiffness=2000.0)) == 0.0
    soft = make_wall(0.5, 0.0, 0, HAND, stiffness=20.0)
    assert calc_largest_delay(soft) == math.inf
    for delay in (10, 40, 77, 150):
        assert replace(soft, delay_s=delay * T).calc_spectral_radius() < 1.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": 0.0}, "mass must be positive, is 0"),
        ({"period_s": math.nan}, "period_s must be positive, is nan"),
        ({"damping": -1.0}, "damping must be at least 0, is -1"),
        ({"delay_s": -1e-3}, "delay_s must be at least 0, is -0.001"),
        ({"hand_mass": math.inf}, "hand_mass must be at least 0, is inf"),
    ],
)
def test_what_cannot_be_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        SampledWall(**{"mass": 0.1, "damping": 0.5, "period_s": T} | change)
