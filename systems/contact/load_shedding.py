"""Drops work in a fixed order when ticks take too long."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from pydrake.systems.framework import Context, DiscreteValues, EventStatus

from drake_haptics._core import AutoDiffVector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)

# Work that is dropped, in this order.
SHED_STAGES = ("drawing", "far near-contacts", "fine clusters")
# Ticks over the budget that drop a stage: so many that forces change smoothly and a
# single tick that the operating system delays drops next to nothing.
_TICKS_TO_DROP = 50
# Ticks well below the budget that restore a stage.
_TICKS_TO_RESTORE = 1000
_WELL_BELOW = 0.8
# Share of the tolerance up to which near contacts are always found, and push.
_LEAST_REACH = 0.25


class TickMeter:
    """Times the work of each tick, from its first event to its last."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter):
        """Constructs the meter.

        Args:
            clock: Function that returns the time, s.
        """
        self._clock = clock
        self._start_s = math.inf
        self._busy_s = 0.0

    @property
    def busy_s(self) -> float:
        """Duration of the last complete tick, s; 0 before the first one."""
        return self._busy_s

    def begin(self) -> None:
        """Begins a tick."""
        self._start_s = self._clock()

    def end(self) -> None:
        """Ends the tick; does nothing between two ticks."""
        if self._start_s < math.inf:
            self._busy_s = self._clock() - self._start_s
            self._start_s = math.inf


class TickEnd(DifferentiableSystem):
    """Ends the `TickMeter`'s tick. It must be the last system of its diagram.

    .. pydrake_system::

        name: TickEnd
    """

    def __init__(self, meter: TickMeter, period_s: float):
        """Constructs the system.

        Args:
            meter: Meter of the `LoadShedding`.
            period_s: Time from tick to tick, s.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        self._meter = meter
        # Publish events come after all other work of the previous tick.
        self.DeclarePeriodicPublishEvent(period_s, 0.0, self._publish)

    def _publish(self, context: Context) -> EventStatus:
        self._meter.end()
        return EventStatus.Succeeded()


class LoadShedding(DifferentiableSystem):
    """Decides how much work a loop drops, so that its ticks stay within a budget.

    Work is dropped in stages, each gradually, and restored in the reverse order:

    1. drawing: no new frame is begun;
    2. far near-contacts: the distance within which contacts are searched for, push and
       brake shrinks to a quarter;
    3. fine clusters: of contacts that are nearer to each other than a cell, and whose
       normals differ by less than 45°, only the deepest pushes.

    A penetration always keeps its deepest contact, and the device's limits, checks and
    gate are never dropped.

    .. pydrake_system::

        name: LoadShedding
        output_ports:
        - load_shedding

    `load_shedding` (3) is [shed, reach share, cell]: how much is dropped, 0 (nothing)
    to 3 (all stages), the share of the distances that is left, 1 to 1/4, and the size
    of the cell, m, 0 while all clusters count. It is the state, one discrete group,
    updated every period from 0 s on.

    The time of the last tick is an input that is not in the Context: it is read once
    per tick. The system must be the first one of its diagram with an update, and a
    `TickEnd` the last.
    """

    def __init__(
        self, meter: TickMeter, period_s: float, budget_s: float, largest_cell_m: float
    ):
        """Constructs the system.

        Args:
            meter: Meter that times the ticks.
            period_s: Time from tick to tick, s.
            budget_s: Time that the work of a tick may take, s.
            largest_cell_m: Size of the cell when all stages are dropped, m.

        Raises:
            ValueError: A period, the budget or the cell is not positive.
        """
        super().__init__()
        check_positive(
            period_s=period_s, budget_s=budget_s, largest_cell_m=largest_cell_m
        )
        self._meter = meter
        self._budget_s = budget_s
        self._largest_cell_m = largest_cell_m
        state = self.DeclareDiscreteState(self._describe(0.0))
        self._load_shedding = self.DeclareStateOutputPort("load_shedding", state)
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        shed = float(context.get_discrete_state_vector().value()[0])
        next_state.set_value(self._describe(self._find_next(shed)))
        self._meter.begin()

    def _find_next(self, shed: float) -> float:
        """Returns how much is dropped after the tick that was measured."""
        if self._meter.busy_s > self._budget_s:
            return min(float(len(SHED_STAGES)), shed + 1.0 / _TICKS_TO_DROP)
        if self._meter.busy_s < _WELL_BELOW * self._budget_s:
            return max(0.0, shed - 1.0 / _TICKS_TO_RESTORE)
        return shed

    def _describe(self, shed: float) -> np.ndarray:
        """Returns `load_shedding`."""
        thinned = min(max(shed - 1.0, 0.0), 1.0)
        coarsened = max(shed - 2.0, 0.0)
        return np.array(
            [
                shed,
                1.0 - (1.0 - _LEAST_REACH) * thinned,
                self._largest_cell_m * coarsened,
            ]
        )

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the state."""
        return at.state

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the state unchanged: a linearization drops nothing."""
        return at.state
