"""Calculates exactly the stability of a sampled wall on a handle with one axis.

The handle has mass m and damper b, and a hand may hold it by mass m_h, damper b_h and
spring k_h. Every period T the wall's force -(K x + B v) is calculated from the sampled
position, shown t_d later and then held. Between the changes of the force the flow is
linear, so one period is a matrix, and stability its spectral radius. The six-axis
linearization of a Drake diagram must agree with it for motions along one axis.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.common.value_checks import check_at_least, check_positive

# Ratio of the stiffnesses that are tried before the edge is bisected.
_STEP = 2.0 ** (1.0 / 8.0)
# Softest wall that is tried, as K T²/m; softer ones are like a free handle.
_SOFTEST_ALPHA = 1e-6
_RELATIVE_TOLERANCE = 1e-10
# Delays that differ by less than this part of a period are equal.
_DELAY_TOLERANCE = 1e-9
# Each period of delay is a row of the matrix, whose eigenvalues then take 2 s.
_MOST_PERIODS = 1000
# The search for the longest delay ends here: beyond, its first estimate may be wrong by
# more than two periods.
_MOST_SEARCHED = 500


@dataclass(frozen=True)
class SampledWall:
    """A wall on a held handle, along or about one axis.

    All values hold for rotation too, in kg·m², N·m·s/rad and N·m/rad.

    Attributes:
        mass: m of the handle, kg.
        damping: b, physical damping of the handle, N·s/m.
        period_s: T, s.
        stiffness: K of the wall, N/m.
        wall_damping: B of the wall, N·s/m.
        delay_s: t_d, delay of the force on top of the hold, s; not only whole periods,
            and at most 1,000 of them.
        hand_mass: m_h, kg; it moves with the handle.
        hand_damping: b_h, N·s/m.
        hand_stiffness: k_h, N/m.
        true_velocity: Whether the wall's damper sees the handle's velocity itself,
            instead of the backward difference of its positions.
    """

    mass: float
    damping: float
    period_s: float
    stiffness: float = 0.0
    wall_damping: float = 0.0
    delay_s: float = 0.0
    hand_mass: float = 0.0
    hand_damping: float = 0.0
    hand_stiffness: float = 0.0
    true_velocity: bool = False

    def __post_init__(self) -> None:
        """Checks the values.

        Raises:
            ValueError: The mass or the period is not positive, another value is
                negative or not a number, or the delay is too long.
        """
        check_positive(mass=self.mass, period_s=self.period_s)
        check_at_least(
            0,
            damping=self.damping,
            stiffness=self.stiffness,
            wall_damping=self.wall_damping,
            delay_s=self.delay_s,
            hand_mass=self.hand_mass,
            hand_damping=self.hand_damping,
            hand_stiffness=self.hand_stiffness,
        )
        if self.delay_s > (_MOST_PERIODS + _DELAY_TOLERANCE) * self.period_s:
            raise ValueError(
                f"delay_s must be at most {_MOST_PERIODS:,} periods of"
                f" {self.period_s:g} s, is {self.delay_s:g}; give it in seconds, or"
                " calculate the wall with a longer period"
            )

    def make_step_matrix(self) -> np.ndarray:
        """Returns A of z[k+1] = A z[k], just before each sample.

        The state is x, v, the x of the previous sample, and the forces that are still
        to be shown or just shown, newest first.
        """
        T = self.period_s
        whole = math.floor(self.delay_s / T + _DELAY_TOLERANCE)
        late_s = self.delay_s - whole * T
        if late_s < _DELAY_TOLERANCE * T:
            late_s = 0.0
        forces = whole + (late_s > 0.0)
        size = 3 + forces
        difference = 0.0 if self.true_velocity else self.wall_damping / T
        force = np.zeros(size)
        force[0] = -self.stiffness - difference
        force[1] = -self.wall_damping if self.true_velocity else 0.0
        force[2] = difference
        # Row k is the force that is shown k periods after its calculation.
        shown = np.vstack([force, np.eye(size)[3:]])

        A = np.zeros((size, size))
        flow, push = self._calc_flow(T - late_s)
        if late_s > 0.0:
            late_flow, late_push = self._calc_flow(late_s)
            A[:2] = np.outer(flow @ late_push, shown[whole + 1])
            flow_of_all = flow @ late_flow
        else:
            flow_of_all = flow
        A[:2, :2] += flow_of_all
        A[:2] += np.outer(push, shown[whole])
        A[2, 0] = 1.0
        A[3:] = shown[:forces]
        return A

    def calc_spectral_radius(self) -> float:
        """Returns the largest growth per period of a mode, which is stable below 1."""
        return float(np.abs(np.linalg.eigvals(self.make_step_matrix())).max())

    def _calc_flow(self, time_s: float) -> tuple[np.ndarray, np.ndarray]:
        """Returns Φ (2, 2) and Γ (2,) of [x, v] under a force held for a time."""
        return _calc_flow(
            self.mass + self.hand_mass,
            self.damping + self.hand_damping,
            self.hand_stiffness,
            time_s,
        )


# A search changes the wall many times, but not what it acts on.
@lru_cache(maxsize=64)
def _calc_flow(
    m: float, b: float, k: float, time_s: float
) -> tuple[np.ndarray, np.ndarray]:
    rate = np.array([[0.0, 1.0, 0.0], [-k / m, -b / m, 1.0 / m], [0.0, 0.0, 0.0]])
    flow = expm(rate * time_s)
    flow.flags.writeable = False
    return flow[:2, :2], flow[:2, 2]


@on_one_blas_thread
def calc_largest_stiffness(wall: SampledWall) -> float:
    """Returns the stiffness K below which every wall is stable.

    It tries stiffer walls, a factor of 1.09 apart, until one is unstable, and finds
    the edge to 1e-10 of K. A stable wall beyond an unstable one would be missed (tests
    over random walls found no such case). The result is zero if even the softest is
    unstable, as with too much damping of the wall.

    Args:
        wall: The wall, whose stiffness is not used.
    """
    # The search ends, because a stiff enough spring that is held for a period throws
    # the handle back farther than it was.
    return _find_edge(
        lambda stiffness: replace(wall, stiffness=stiffness),
        start=_SOFTEST_ALPHA * (wall.mass + wall.hand_mass) / wall.period_s**2,
        step=lambda stiffness: (_STEP - 1.0) * stiffness,
    )


@on_one_blas_thread
def calc_gain_margin(wall: SampledWall) -> float:
    """Returns the factor on both K and B up to which the wall is stable.

    It is searched for as in `calc_largest_stiffness`, from factors far below one, and
    is infinite if both gains are zero.

    Args:
        wall: The wall; the margin is above 1 if it is stable.
    """
    K, B, T = wall.stiffness, wall.wall_damping, wall.period_s
    if K == B == 0.0:
        return math.inf
    mass = wall.mass + wall.hand_mass
    return _find_edge(
        lambda factor: replace(wall, stiffness=factor * K, wall_damping=factor * B),
        start=_SOFTEST_ALPHA * mass / T**2 / (K + B / T),
        step=lambda factor: (_STEP - 1.0) * factor,
    )


@on_one_blas_thread
def calc_largest_delay(wall: SampledWall) -> float:
    """Returns the delay t_d below which every delay is stable, s.

    A delay turns the loop gain and keeps its size, so that the first unstable delay is
    near the least one that turns a loop gain of one against the motion; from two
    periods before that, it tries longer delays, a quarter of a period apart, until one
    is unstable, and finds the edge to a relative 1e-10. The result is zero if the wall
    is unstable without delay, and infinite if its loop gain is below one at every
    frequency, as for a soft wall in a firm hand. It is 500 periods if that and more is
    stable.

    Args:
        wall: The wall, whose delay is not used.
    """
    if replace(wall, delay_s=0.0).calc_spectral_radius() >= 1.0:
        return 0.0
    periods = _estimate_delay(wall)
    if periods == math.inf:
        return math.inf
    first = max(0, math.floor(periods) - 2)
    if first >= _MOST_SEARCHED:
        return _MOST_SEARCHED * wall.period_s
    return _find_edge(
        lambda delay_s: replace(wall, delay_s=delay_s),
        start=first * wall.period_s,
        step=lambda delay_s: 0.25 * wall.period_s,
    )


def _find_edge(
    make_wall: Callable[[float], SampledWall],
    start: float,
    step: Callable[[float], float],
) -> float:
    """Returns the value from which walls are unstable; 0 if the first one is."""

    def is_stable(value: float) -> bool:
        return make_wall(value).calc_spectral_radius() < 1.0

    if not is_stable(start):
        return 0.0
    stable = start
    while is_stable(tried := stable + step(stable)):
        stable = tried
    return float(
        brentq(
            lambda value: make_wall(value).calc_spectral_radius() - 1.0,
            stable,
            tried,
            xtol=0.5 * _RELATIVE_TOLERANCE * tried,
        )
    )


def _estimate_delay(wall: SampledWall) -> float:
    """Returns the periods of delay that turn a loop gain of one by half a turn.

    It is infinite if the loop gain is below one at every frequency.
    """
    angles, gain = _calc_loop_gain(wall)
    size = np.abs(gain)
    if size.max() < 1.0:
        return math.inf
    if size[-1] >= 1.0:  # Two samples per oscillation: one more period is half a turn.
        return 0.0
    crossed = np.flatnonzero(np.diff(size >= 1.0))
    left = np.mod(math.pi + np.angle(gain[crossed]), 2.0 * math.pi)
    return float((left / angles[crossed]).min())


def _calc_loop_gain(wall: SampledWall) -> tuple[np.ndarray, np.ndarray]:
    """Returns phases per period, rad, and the loop gain of the wall's force there."""
    flow, push = wall._calc_flow(wall.period_s)
    angles = np.geomspace(1e-6, math.pi, 4000)
    z = np.exp(1j * angles)
    # The response of [x, v] to the held force: (z I - Φ)⁻¹ Γ.
    response = np.linalg.solve(
        z[:, None, None] * np.eye(2) - flow,
        np.broadcast_to(push[:, None], (4000, 2, 1)),
    )[:, :, 0]
    if wall.true_velocity:
        force = wall.stiffness * response[:, 0] + wall.wall_damping * response[:, 1]
    else:
        B = wall.wall_damping / wall.period_s * (1.0 - 1.0 / z)
        force = (wall.stiffness + B) * response[:, 0]
    return angles, force
