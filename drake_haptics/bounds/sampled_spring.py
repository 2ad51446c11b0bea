"""Calculates limits of stiffness and damping of a sampled spring on a device.

A spring K and damper B, calculated once per period T from sampled positions, held in
between, and delayed by t_d, act on a handle of mass m whose device and hand damp it by
b. Each bound holds for translation (N/m, N·s/m, kg) and for rotation (N·m/rad,
N·m·s/rad, kg·m²). The velocity is the backward difference of the positions, as from an
encoder.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from drake_haptics.common.value_checks import check_at_least, check_positive

# Hands that explore by touch are slower.
_FASTEST_HAND_M_PER_S = 1.0


def calc_passive_damping(
    stiffness: float, damping: float, period_s: float, delay_s: float = 0.0
) -> float:
    """Returns the physical damping b that makes a sampled K and B passive.

    If `b > K T/2 + |B|` (Colgate and Schenkel 1997), no passive hand can be driven into
    motion. With a delay t_d, `b > K (T/2 + t_d) + |B|` is sufficient; it is also
    necessary if B is zero or negative. A delay between whole periods counts as the mean
    of itself and the next whole period (docs/stability-theory.md).
    """
    return stiffness * _calc_age(period_s, delay_s) + abs(damping)


def calc_passive_stiffness(
    held_damping: float, damping: float, period_s: float, delay_s: float = 0.0
) -> float:
    """Returns the stiffness K up to which a sampled K and B are passive.

    It is the bound of `calc_passive_damping`, solved for K, and zero if B alone is not
    passive.

    Raises:
        ValueError: The period is not positive, or the physical damping or the delay is
            negative.
    """
    _check_loop(held_damping, period_s, delay_s)
    left = held_damping - abs(damping)
    return max(0.0, left) / _calc_age(period_s, delay_s)


def calc_stable_stiffness(
    held_damping: float, damping: float, period_s: float, delay_s: float = 0.0
) -> float:
    """Returns the stiffness K below which the sampled loop is stable.

    K < (b + B) / (T/2 + t_d) (Gil et al. 2004; Hulin et al. 2009), to first order in
    b T/m and B T/m: for dampings that are small against m/T.

    Raises:
        ValueError: The period is not positive, or the physical damping or the delay is
            negative.
    """
    _check_loop(held_damping, period_s, delay_s)
    return (held_damping + damping) / (period_s / 2.0 + delay_s)


def calc_stable_delay(
    stiffness: float, held_damping: float, damping: float, period_s: float
) -> float:
    """Returns the delay t_d below which the sampled loop is stable, s.

    t_d < (b + B)/K - T/2, the law of `calc_stable_stiffness` solved for the delay. It
    is also the longest allowed stall of the loop, which delays the force as much. It is
    zero if the loop is unstable without delay, and infinite without stiffness.
    """
    if stiffness == 0.0:
        return math.inf
    return max(0.0, (held_damping + damping) / stiffness - period_s / 2.0)


def calc_quantized_stiffness(
    held_damping: float, friction: float, period_s: float, resolution: float
) -> float:
    """Returns the stiffness up to which a spring on an encoder is passive.

    K <= min(2 b/T, 2 f_c/Δ) (Abbott and Okamura 2005): damping compensates for
    sampling, and Coulomb friction for quantization.

    Args:
        held_damping: Damping b of device and hand, N·s/m or N·m·s/rad.
        friction: f_c, Coulomb friction at the handle, N or N·m.
        period_s: T, s.
        resolution: Δ, the step of the position, m or rad.
    """
    return min(2.0 * held_damping / period_s, 2.0 * friction / resolution)


def calc_sampled_stiffness(mass: float, damping: float, period_s: float) -> float:
    """Returns the stiffness K below which K and B are stable on a free mass.

    Exactly, without delay and physical damping: K T²/m < 2 β (2 - β) / (2 + β) with β =
    B T/m < 2; Jury's criterion on 2 z³ + (α + β - 4) z² + (2 + α) z - β. It is zero if
    no stiffness is stable.
    """
    beta = damping * period_s / mass
    alpha = 2.0 * beta * (2.0 - beta) / (2.0 + beta)
    return max(0.0, alpha) * mass / period_s**2


def calc_sampled_damping(mass: float, stiffness: float, period_s: float) -> float:
    """Returns the largest B that is stable with a stiffness K on a free mass.

    The upper root of Jury's boundary, 2 β² + (α - 4) β + 2 α = 0 with α = K T²/m and β
    = B T/m: 2 m/T for K = 0, and less with a spring. It is zero if the spring is too
    stiff for any damping, α > 12 - 8 √2.
    """
    alpha = stiffness * period_s**2 / mass
    if alpha >= 4.0:
        return 0.0
    square = (4.0 - alpha) ** 2 - 16.0 * alpha
    if square < 0.0:
        return 0.0
    return (4.0 - alpha + math.sqrt(square)) / 4.0 * mass / period_s


def calc_returnable_energy(
    springs: Iterable[tuple[float, float]], tool_mass_kg: float, lift_J: float = 0.0
) -> float:
    """Returns the energy that a passive virtual world can return to a device, J.

    That is the energy of its springs, F²/(2 K) each, of the tool's motion, and of its
    weight. It is the `reserve_J` of a `PassivityControl`; a larger balance comes from
    dissipation.

    Args:
        springs: The largest load and the stiffness of each, in N and N/m or N·m and
            N·m/rad: the two of the coupling at the device's limits, and that of the
            softest contact. Springs without stiffness are skipped.
        tool_mass_kg: Mass of the tool, kg, which a hand moves with at most 1 m/s.
        lift_J: Weight of the tool times its largest lift, J; 0 without gravity.
    """
    elastic = sum(load**2 / (2.0 * k) for load, k in springs if k > 0.0)
    return elastic + 0.5 * tool_mass_kg * _FASTEST_HAND_M_PER_S**2 + lift_J


def _check_loop(held_damping: float, period_s: float, delay_s: float) -> None:
    check_positive(period_s=period_s)
    check_at_least(0, held_damping=held_damping, delay_s=delay_s)


def _calc_age(period_s: float, delay_s: float) -> float:
    """Returns the age at which a sample counts for passivity, s."""
    # A delay of whole periods may be a round-off above them.
    next_whole_s = math.ceil(delay_s / period_s - 1e-9) * period_s
    return 0.5 * (period_s + delay_s + next_whole_s)
