"""The bounds on sampled springs, against the loops that they speak of."""

import numpy as np
import pytest
from scipy.linalg import expm

from drake_haptics.bounds.sampled_spring import (
    calc_passive_damping,
    calc_passive_stiffness,
    calc_quantized_stiffness,
    calc_returnable_energy,
    calc_sampled_damping,
    calc_sampled_stiffness,
    calc_stable_delay,
    calc_stable_stiffness,
)

T, MASS = 1e-3, 0.1


def calc_growth(mass, held, K, B, delay_ticks=0):
    """Returns the spectral radius of the sampled loop, discretized exactly.

    A mass with damper `held` in continuous time; the force -(K x + B Δx/T) of sampled
    positions is held, and shown `delay_ticks` later.
    """
    flow = expm(np.array([[0, 1, 0], [0, -held / mass, 1 / mass], [0, 0, 0]]) * T)
    # State: x, v, the last x, then the forces still to be shown, the next one last.
    size = 3 + delay_ticks
    force = np.zeros(size)
    force[[0, 2]] = -(K + B / T), B / T
    shown = force if delay_ticks == 0 else np.eye(size)[-1]
    step = np.zeros((size, size))
    step[:2, :2] = flow[:2, :2]
    step[:2] += np.outer(flow[:2, 2], shown)
    step[2, 0] = 1
    if delay_ticks:
        step[3] = force
        step[4:, 3:-1] = np.eye(delay_ticks - 1)
    return abs(np.linalg.eigvals(step)).max()


@pytest.mark.parametrize(("K", "B"), [(800.0, 2.0), (5000.0, 0.0), (0.0, 1.0)])
def test_passive_damping_is_the_largest_of_the_general_expression(K, B):
    """That is b > T / (2 (1 - cos ωT)) Re{(1 - e^-jωT) H(e^jωT)} up to ω = π/T."""
    angle = np.linspace(1e-3, np.pi, 20001)
    z = np.exp(1j * angle)
    H = K + B * (z - 1) / (T * z)
    needed = T / (2 * (1 - np.cos(angle))) * ((1 - 1 / z) * H).real
    assert calc_passive_damping(K, B, T) == pytest.approx(needed.max(), rel=1e-6)


def test_negative_damping_needs_as_much_as_positive():
    assert calc_passive_damping(100.0, -3.0, T) == calc_passive_damping(100.0, 3.0, T)


@pytest.mark.parametrize("K", [300.0, 5000.0])
@pytest.mark.parametrize("B", [-2.0, 0.0, 1.0])
@pytest.mark.parametrize("delay_ticks", [1, 2, 5])
def test_passive_damping_with_a_delay_is_enough(K, B, delay_ticks):
    """The general expression of H z⁻ᵈ, which needs all of it at ω = 0 if B <= 0."""
    angle = np.linspace(1e-4, np.pi, 20001)
    z = np.exp(1j * angle)
    H = (K + B * (z - 1) / (T * z)) * z**-delay_ticks
    needed = (T / (2 * (1 - np.cos(angle))) * ((1 - 1 / z) * H).real).max()
    bound = calc_passive_damping(K, B, T, delay_ticks * T)
    assert needed <= bound * (1 + 1e-6)
    if B <= 0:
        assert needed == pytest.approx(bound, rel=1e-5)


@pytest.mark.parametrize("delay_s", [0.0, 0.3e-3, 1e-3, 2.6e-3])
@pytest.mark.parametrize("B", [-1.5, 0.0, 1.5])
def test_passive_stiffness_needs_all_of_the_damping(delay_s, B):
    K = calc_passive_stiffness(2.0, B, T, delay_s)
    assert calc_passive_damping(K, B, T, delay_s) == pytest.approx(2.0)
    assert calc_passive_stiffness(1.0, B, T, delay_s) == (0.0 if B else K / 2)


@pytest.mark.parametrize("delay_s", [0.0, 0.3e-3, 1e-3, 2.6e-3])
def test_passive_damping_with_any_delay_pays_for_every_motion(delay_s):
    """The work that a held, delayed spring does beyond an ideal one: ∫ K v (x_old - x).

    Of all velocities of a size, the largest eigenvalue of that form's symmetric part
    gains most. Long motions approach the bound from below, where the delay is whole.
    """
    K, fine, ticks = 800.0, 10, 60
    time = np.arange(fine * ticks) * T / fine + T / fine / 2
    sample = np.floor((time - delay_s) / T) * T
    # x(t) - x(sample) = ∫ v from the sample to t, on cells with their middles in it.
    form = (time > sample[:, None]) & (time < time[:, None])
    form = K * T / fine * (form + 0.5 * np.eye(len(time)))
    needed = np.linalg.eigvalsh((form + form.T) / 2)[-1]
    bound = calc_passive_damping(K, 0.0, T, delay_s)
    assert needed <= bound * (1 + 1e-9)
    assert needed > (0.9 if delay_s in (0.0, T) else 0.7) * bound


@pytest.mark.parametrize(("K", "held", "B"), [(300.0, 0.5, 0.2), (100.0, 0.1, 0.4)])
def test_stable_delay_is_where_the_sampled_loop_begins_to_grow(K, held, B):
    ticks = calc_stable_delay(K, held, B, T) / T
    assert 1 < ticks < 5
    assert calc_growth(MASS, held, K, B, int(np.floor(0.95 * ticks))) < 1
    assert calc_growth(MASS, held, K, B, int(np.ceil(1.05 * ticks))) > 1


def test_the_stall_of_the_notes_needs_the_damping_of_the_notes():
    # 500 N/m over 20 ms, and half a period.
    assert calc_stable_delay(500.0, 4.0, 6.25, T) == pytest.approx(20e-3)
    assert calc_stable_delay(500.0, 0.1, 0.1, T) == 0.0
    assert calc_stable_delay(0.0, 0.1, 0.1, T) == np.inf


@pytest.mark.parametrize(
    ("held", "B", "delay"), [(0.5, 0, 0), (0.5, 0.2, 0), (0.1, 0.5, 1), (0.5, 0, 3)]
)
def test_stable_stiffness_is_where_the_sampled_loop_begins_to_grow(held, B, delay):
    K = calc_stable_stiffness(held, B, T, delay * T)
    # The law is of first order in b T/m and B T/m, here 0.6 % together.
    assert calc_growth(MASS, held, 0.97 * K, B, delay) < 1
    assert calc_growth(MASS, held, 1.03 * K, B, delay) > 1


@pytest.mark.parametrize("beta", [0.05, 0.4, 2 * np.sqrt(2) - 2, 1.5, 1.95])
def test_sampled_stiffness_is_exact_on_a_free_mass(beta):
    B = beta * MASS / T
    K = calc_sampled_stiffness(MASS, B, T)
    # One at the edge; a pole that has left the circle there tells which side it is.
    assert calc_growth(MASS, 0.0, K * (1 - 1e-4), B) < 1
    assert calc_growth(MASS, 0.0, K * (1 + 1e-4), B) > 1


def test_no_stiffness_is_stable_with_too_much_damping():
    assert calc_sampled_stiffness(MASS, 2.1 * MASS / T, T) == 0.0


def test_the_stiffest_spring_of_all_is_that_of_the_notes():
    stiffest = max(
        calc_sampled_stiffness(MASS, b * MASS / T, T) for b in np.linspace(0, 2, 100001)
    )
    assert stiffest * T**2 / MASS == pytest.approx(12 - 8 * np.sqrt(2), abs=1e-8)


@pytest.mark.parametrize("alpha", [0.0, 0.01, 0.3, 0.68])
def test_sampled_damping_is_the_upper_edge_of_the_same_region(alpha):
    K = alpha * MASS / T**2
    B = calc_sampled_damping(MASS, K, T)
    assert calc_growth(MASS, 0.0, K, B * (1 - 1e-4)) < 1 + (alpha == 0.0) * 1e-12
    assert calc_growth(MASS, 0.0, K, B * (1 + 1e-4)) > 1
    if alpha > 0:
        assert calc_sampled_stiffness(MASS, B, T) == pytest.approx(K)


@pytest.mark.parametrize("alpha", [0.69, 3.9, 4.0, 30.0])
def test_no_damping_is_stable_with_too_stiff_a_spring(alpha):
    assert calc_sampled_damping(MASS, alpha * MASS / T**2, T) == 0.0


@pytest.mark.parametrize("friction", [0.0, 0.01, 0.04, 1.0])
def test_quantized_stiffness_is_the_edge_of_a_two_sample_cycle(friction):
    """In and out by X: K (X + Δ) X gained, 2 b X²/T and 2 f_c X dissipated."""
    b, resolution = 0.5, 3e-5
    X = np.geomspace(1e-9, 1.0, 400)

    def gain(K):
        return K * (X + resolution) * X - 2 * b * X**2 / T - 2 * friction * X

    K = calc_quantized_stiffness(b, friction, T, resolution)
    assert gain(K).max() <= 0
    assert gain(1.01 * K + 1.0).max() > 0


def test_returnable_energy_is_that_of_springs_motion_and_weight():
    springs = [(8.5, 800.0), (0.188, 1.0), (8.5, 0.0)]
    expected = 8.5**2 / 1600 + 0.188**2 / 2 + 0.5 * 0.1 + 0.2
    assert calc_returnable_energy(springs, 0.1, 0.2) == pytest.approx(expected)


@pytest.mark.parametrize("calc", [calc_passive_stiffness, calc_stable_stiffness])
@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        ({"period_s": 0.0}, "period_s must be positive and finite, is 0.0"),
        ({"period_s": -T}, "period_s must be positive and finite, is -0.001"),
        ({"delay_s": -T}, "delay_s must be at least 0 and finite, is -0.001"),
        ({"delay_s": np.nan}, "delay_s must be at least 0 and finite, is nan"),
        ({"held_damping": -1.0}, "held_damping must be at least 0 and finite, is -1.0"),
    ],
)
def test_no_bound_is_given_for_what_is_no_loop(calc, wrong, complaint):
    loop = {"held_damping": 1.0, "damping": 1.0, "period_s": T, "delay_s": 0.0}
    with pytest.raises(ValueError, match=f"^{complaint}$"):
        calc(**loop | wrong)
