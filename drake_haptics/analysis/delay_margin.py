"""Calculates the delay margin: how late a loop's force may come."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from drake_haptics.analysis.held_loop import HeldLoop
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.stability_limit import calc_growth

# Steps between delays until the edge is bracketed, in periods and as a share of the
# delay.
_STEP, _STEP_SHARE = 0.25, 0.2
# Longest delay that is tried, in periods.
LONGEST_DELAY = 50.0
_TOLERANCE = 1e-4


@on_one_blas_thread
def calc_delay_margin(loop: HeldLoop) -> float:
    """Returns the additional delay of the device's force at which motions grow, s.

    The wrench that the hold samples is shown later by that delay; nothing else changes.
    The result is infinite if 50 periods are not enough, and 0 if the loop is already
    unstable.

    Args:
        loop: The loop at its equilibrium.
    """

    def excess(delay: float) -> float:
        return calc_growth(np.linalg.eigvals(make_delayed_map(loop, delay))) - 1.0

    low = high = 0.0
    if excess(high) >= 0.0:
        return 0.0
    while excess(high) < 0.0:
        if high >= LONGEST_DELAY:
            return np.inf
        step = max(_STEP, _STEP_SHARE * high)
        low, high = high, min(high + step, LONGEST_DELAY)
    return loop.linearization.period_s * brentq(excess, low, high, xtol=_TOLERANCE)


def make_delayed_map(loop: HeldLoop, delay: float) -> np.ndarray:
    """Returns the map of one period with the device's wrench delayed.

    The state is that of the linearization, then the wrenches (6 each) that were sampled
    and not yet shown, newest first.

    Args:
        loop: The loop at its equilibrium.
        delay: Delay in periods, at least 0; it need not be whole.

    Raises:
        ValueError: The delay is negative.
    """
    if not delay >= 0.0:
        raise ValueError(f"delay must be at least 0 periods, is {delay}")
    linear = loop.linearization
    n, T = len(linear.A), linear.period_s
    shown = find_shown_wrench(linear.state_names)
    whole = int(delay + 1e-9)
    late = max(0.0, delay - whole)
    late = 0.0 if late < 1e-9 else late
    waiting = whole + (late > 0.0)
    size = n + 6 * waiting

    def flow(periods: float) -> np.ndarray:
        moved = np.eye(size)
        moved[:n, :n] = expm(linear.rates * periods * T)
        return moved

    # Entries of the queue after the update, as functions of the state before it.
    sampled = np.zeros((6, size))
    sampled[:, :n] = linear.update[shown]
    queue = np.vstack([sampled, np.eye(size)[n:]])
    update = np.eye(size)
    update[:n, :n] = linear.update
    update[shown] = queue[6 * whole : 6 * whole + 6]
    update[n:] = queue[: 6 * waiting]
    if late == 0.0:
        return flow(1.0) @ update
    # Until the delay has passed, the previous wrench is still shown.
    update[shown] = queue[6 * whole + 6 : 6 * whole + 12]
    switch = np.eye(size)
    switch[shown] = np.eye(size)[n + 6 * whole : n + 6 * whole + 6]
    return flow(1.0 - late) @ switch @ flow(late) @ update


def find_shown_wrench(names: tuple[str, ...]) -> np.ndarray:
    """Returns the indices in a named state of the wrench (6) that the handle feels.

    It is the wrench of the device's hold, or the last sample of a simulated device's
    delay.
    """
    delayed = [i for i, name in enumerate(names) if "force_delay" in name]
    if delayed:
        return np.array(delayed[-6:])
    hold = [i for i, name in enumerate(names) if "rendered_force_hold" in name]
    return np.array(hold[:6])
