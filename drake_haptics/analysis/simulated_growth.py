"""How fast a disturbance grows or dies out, seen in simulation."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context

from drake_haptics.analysis.sampled_map import get_state, set_state

# So small that nothing but the linear part of the motion is seen, and so large that
# round-off is not: relative to states of meters, radians and newtons.
_DISTURBANCE = 1e-7
# A mode is followed until it is so many times larger or smaller than it began.
_FOLLOWED = 1e4
_FEWEST_PERIODS = 20


def measure_growth(
    make_simulator: Callable[[Context], Simulator],
    context: Context,
    eigenvectors: tuple[np.ndarray, np.ndarray],
    period_s: float,
    *,
    periods: int = 300,
) -> float:
    """Returns by how much a mode is multiplied in a period, in simulation.

    Two runs start beside each other, one at the state of the context, one disturbed
    along the mode. What both do alike, as drifting, cancels in their difference, and
    the left eigenvector takes the mode out of it.

    Args:
        make_simulator: Returns a simulator that starts at the context it is given.
        context: Root context, at an equilibrium.
        eigenvectors: The mode's right and left one, (n,) each, over [x_c; all discrete
            groups], of any length.
        period_s: T, s.
        periods: How many to simulate at most.

    Raises:
        ValueError: The disturbance is gone, or has left the linear part of the motion,
            after a few periods.
    """
    right, left = eigenvectors
    disturbance = np.real(right / np.abs(right).max()) * _DISTURBANCE
    start = get_state(context)
    contexts = [context.Clone(), context.Clone()]
    set_state(contexts[1], start + disturbance)
    runs = [make_simulator(clone) for clone in contexts]
    start_s = context.get_time()
    logarithms = [math.log(abs(np.vdot(left, disturbance)))]
    for k in range(1, periods + 1):
        for run in runs:
            run.AdvanceTo(start_s + k * period_s)
        at_rest, disturbed = (get_state(run.get_context()) for run in runs)
        amplitude = abs(np.vdot(left, disturbed - at_rest))
        # Below is round-off, above what is not linear; NaN is neither.
        if not 1.0 / _FOLLOWED < amplitude / math.exp(logarithms[0]) < _FOLLOWED:
            break
        logarithms.append(math.log(amplitude))
    # The first few may hold what else the disturbance has set off.
    followed = logarithms[len(logarithms) // 10 :]
    if len(followed) < _FEWEST_PERIODS:
        raise ValueError(
            f"the disturbance could be followed for {len(logarithms) - 1} periods only:"
            " it grows or dies out too fast"
        )
    return math.exp(np.polyfit(np.arange(len(followed)), followed, 1)[0])
