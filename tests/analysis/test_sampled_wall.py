"""The sampled wall's matrix, against motions integrated without it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from wall_motion import (
    HAND,
    NO_HAND,
    TABLE,
    T,
    find_simulated_limit,
    make_wall,
    measure_growth,
)

from drake_haptics.analysis.sampled_wall import (
    SampledWall,
    calc_largest_delay,
    calc_largest_stiffness,
)
from drake_haptics.bounds.sampled_spring import calc_stable_delay, calc_stable_stiffness


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
    assert find_simulated_limit(wall, K) == pytest.approx(K, rel=1e-4)


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


def test_no_delay_below_the_largest_is_unstable():
    """All delays are tried, a quarter of a period apart, as far as the largest."""
    limited = 0
    for wall in make_random_walls(60):
        wall = replace(wall, stiffness=0.6 * calc_largest_stiffness(wall))
        delay = calc_largest_delay(wall)
        if not 0.0 < delay < 60 * T:
            continue
        limited += 1
        below = [*np.arange(0.0, delay, T / 4), delay * (1 - 1e-7)]
        radius = [replace(wall, delay_s=d).calc_spectral_radius() for d in below]
        assert max(radius) < 1.0, wall
        above = replace(wall, delay_s=delay * (1 + 1e-7))
        assert above.calc_spectral_radius() > 1.0, wall
    assert limited > 20


def test_a_delay_of_many_periods_is_found_by_few_matrices(monkeypatch):
    wall = SampledWall(0.1, 0.5, 1.25e-4, stiffness=20.0, wall_damping=0.2)
    tried = []
    calc = SampledWall.calc_spectral_radius
    monkeypatch.setattr(
        SampledWall,
        "calc_spectral_radius",
        lambda wall: tried.append(wall.delay_s) or calc(wall),
    )
    delay = calc_largest_delay(wall)
    assert delay > 200 * wall.period_s
    assert delay == pytest.approx(calc_stable_delay(20.0, 0.5, 0.2, 1.25e-4), rel=0.1)
    assert len(tried) < 30


def test_a_stiff_wall_bears_no_delay_and_a_soft_one_in_a_hand_any():
    assert calc_largest_delay(make_wall(0.5, 0.0, 0, {}, stiffness=2000.0)) == 0.0
    soft = make_wall(0.5, 0.0, 0, HAND, stiffness=20.0)
    assert calc_largest_delay(soft) == math.inf
    for delay in (10, 40, 77, 150):
        assert replace(soft, delay_s=delay * T).calc_spectral_radius() < 1.0


def test_the_search_for_the_longest_delay_ends_at_a_stable_one():
    wall = SampledWall(0.1, 0.5, 1e-5, stiffness=20.0, wall_damping=0.2)
    delay = calc_largest_delay(wall)
    assert delay == pytest.approx(500 * wall.period_s)
    assert replace(wall, delay_s=delay).calc_spectral_radius() < 1.0
    # The same wall with a longer period, whose search does not end there.
    assert delay < calc_largest_delay(replace(wall, period_s=1.25e-4))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": 0.0}, "mass must be positive and finite, is 0"),
        ({"period_s": math.nan}, "period_s must be positive and finite, is nan"),
        ({"damping": -1.0}, "damping must be at least 0 and finite, is -1"),
        ({"delay_s": -1e-3}, "delay_s must be at least 0 and finite, is -0.001"),
        ({"hand_mass": math.inf}, "hand_mass must be at least 0 and finite, is inf"),
        (
            {"delay_s": 10.0},
            r"at most 1,000 periods of 0\.001 s, is 10; give it in sec",
        ),
    ],
)
def test_what_cannot_be_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        SampledWall(**{"mass": 0.1, "damping": 0.5, "period_s": T} | change)
