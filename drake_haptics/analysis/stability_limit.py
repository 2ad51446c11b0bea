"""Calculates the growth of disturbances of a loop, and finds limits of stability."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context
from scipy.optimize import brentq

from drake_haptics.analysis.modes import NEUTRAL
from drake_haptics.analysis.sampled_map import get_state, set_state

# Logarithms of values that differ by less cannot be told apart.
_LEAST_TOLERANCE = 1e-12


@dataclass(frozen=True)
class StabilityLimit:
    """The largest value at which a loop is stable.

    Attributes:
        value: The largest stable value; infinite if no value up to `highest` is
            unstable, 0 if none down to `lowest` is stable.
        lowest: Lower end of the range that was searched.
        highest: Upper end of that range.
        evaluations: Number of values that were tried.
        is_crossing: Whether growth passes 1 at the value; False if the growth beyond it
            is unknown, or if there is no limit.
    """

    value: float
    lowest: float
    highest: float
    evaluations: int
    is_crossing: bool


def calc_growth(eigenvalues: np.ndarray) -> float:
    """Returns the factor by which the fastest growing motion grows per period.

    Args:
        eigenvalues: (n,) eigenvalues of one period. Those at 1, to 1e-6, are neutral
            and left out. The growth is NaN if one of them is.
    """
    return float(np.abs(drop_neutral(eigenvalues)).max(initial=0.0))


def drop_neutral(eigenvalues: np.ndarray) -> np.ndarray:
    """Returns eigenvalues (n,) with 0 instead of those at 1, to 1e-6.

    Those belong to states that nothing drives back: adhesion points of friction, a
    balance of energy, the length of a quaternion.
    """
    return np.where(np.abs(eigenvalues - 1.0) <= NEUTRAL, 0.0, eigenvalues)


def find_stability_limit(
    growth: Callable[[float], float],
    start: float,
    *,
    lowest: float,
    highest: float,
    relative_tolerance: float = 1e-4,
) -> StabilityLimit:
    """Finds the smallest value at which motions grow.

    It steps by a factor of two from `start` until the growth passes 1, then finds the
    root. A loop that becomes stable again within a factor of two is missed.

    Args:
        growth: Function of a value that returns the growth per period, as `calc_growth`
            does; NaN if it is unknown, which counts as unstable.
        start: First value to try, in the range.
        lowest: Lower end of the range, above 0.
        highest: Upper end of the range, at least `lowest` and finite.
        relative_tolerance: Relative tolerance of the limit, from 1e-12 on.

    Raises:
        ValueError: The range is empty, infinite or not above 0, `start` is not in it,
            or the tolerance is below round-off or not below 1.
    """
    if not _LEAST_TOLERANCE <= relative_tolerance < 1.0:
        raise ValueError(
            f"relative_tolerance must be from {_LEAST_TOLERANCE:g} to below 1, is"
            f" {relative_tolerance}"
        )
    if not 0.0 < lowest <= start <= highest < math.inf:
        raise ValueError(
            "start must be in the range from lowest to highest, above 0 and finite:"
            f" {lowest:g} <= {start:g} <= {highest:g} is wrong"
        )
    tried: dict[float, float] = {}

    def excess(logarithm: float) -> float:
        if logarithm not in tried:
            found = growth(math.exp(logarithm)) - 1.0
            tried[logarithm] = math.inf if math.isnan(found) else found
        return tried[logarithm]

    def answer(value: float, *, is_crossing: bool = False) -> StabilityLimit:
        return StabilityLimit(value, lowest, highest, len(tried), is_crossing)

    stable = unstable = math.log(start)
    if excess(stable) < 0.0:
        while excess(unstable) < 0.0:
            stable = unstable
            if stable == math.log(highest):
                return answer(math.inf)
            unstable = min(stable + math.log(2.0), math.log(highest))
    else:
        while excess(stable) >= 0.0:
            unstable = stable
            if unstable == math.log(lowest):
                return answer(0.0)
            stable = max(unstable - math.log(2.0), math.log(lowest))
    # If a value cannot be evaluated, only bisection is possible.
    while math.isinf(excess(unstable)) and unstable - stable > relative_tolerance:
        middle = (stable + unstable) / 2.0
        if excess(middle) < 0.0:
            stable = middle
        else:
            unstable = middle
    if math.isinf(excess(unstable)):
        return answer(math.exp(stable))
    root = brentq(excess, stable, unstable, xtol=relative_tolerance)
    return answer(math.exp(root), is_crossing=True)


# Relative to states of meters, radians and newtons: small enough for linear motion, and
# larger than the nanometers of motion that the constraint law leaves in a flush
# contact.
_DISTURBANCE = 1e-6
# A mode is followed until it has changed by this factor.
_FOLLOWED = 1e4
_FEWEST_PERIODS = 20
_MOST_PERIODS = 300
_WINDOW = 10  # periods


def measure_growth(
    make_simulator: Callable[[Context], Simulator],
    context: Context,
    eigenvectors: tuple[np.ndarray, np.ndarray],
    period_s: float,
) -> float:
    """Returns the factor by which a mode grows per period in simulation.

    Two runs start at the state of the context, one of them disturbed along the mode.
    Common motion, such as drift, cancels in their difference, from which the left
    eigenvector extracts the mode.

    Args:
        make_simulator: Function that returns a simulator that starts at a context.
        context: Root context, at an equilibrium.
        eigenvectors: Right and left eigenvector of the mode, (n,) each, over [x_c; all
            discrete groups], of any length.
        period_s: T, s.

    Raises:
        ValueError: After a few periods the disturbance has vanished or is no longer
            linear.
    """
    right, left = eigenvectors
    disturbance = np.real(right / np.abs(right).max()) * _DISTURBANCE
    start = get_state(context)
    contexts = [context.Clone(), context.Clone()]
    set_state(contexts[1], start + disturbance)
    runs = [make_simulator(clone) for clone in contexts]
    start_s = context.get_time()
    logarithms = [math.log(abs(np.vdot(left, disturbance)))]
    for k in range(1, _MOST_PERIODS + 1):
        for run in runs:
            run.AdvanceTo(start_s + k * period_s)
        at_rest, disturbed = (get_state(run.get_context()) for run in runs)
        amplitude = abs(np.vdot(left, disturbed - at_rest))
        # Smaller is round-off, larger is not linear; NaN fails, too.
        if not 1.0 / _FOLLOWED < amplitude / math.exp(logarithms[0]) < _FOLLOWED:
            break
        logarithms.append(math.log(amplitude))
    # The first few may contain other motions that the disturbance has excited.
    followed = np.array(logarithms[len(logarithms) // 10 :])
    if len(followed) < _FEWEST_PERIODS:
        raise ValueError(
            f"the disturbance could be followed for {len(logarithms) - 1} periods only:"
            " it grows or dies out too fast"
        )
    # The median over windows: a contact that opens or closes makes the amplitude jump,
    # which few windows contain and a fitted line would follow.
    rises = followed[_WINDOW:] - followed[:-_WINDOW]
    return math.exp(np.median(rises) / _WINDOW)
