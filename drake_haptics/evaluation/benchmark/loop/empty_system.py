"""Times a diagram of one Python system that does nothing."""

from __future__ import annotations

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiscreteValues, LeafSystem

from drake_haptics.evaluation.benchmark.loop.problem import LoopProblem
from drake_haptics.evaluation.benchmark.loop.simulated_ticks import time_ticks


class EmptyLoop:
    """An empty tick: Drake's Simulator and one call of Python."""

    def __init__(self, problem: LoopProblem, *, paced: bool = False):
        """Makes the system.

        Args:
            problem: Says the tick and how many there are.
            paced: Whether ticks that are timed wait for the clock.
        """
        self._motion = problem.motion
        self._paced = paced
        self._system = _EmptySystem(problem.motion.period_s)

    def observe(self) -> None:
        """Has no tool; see `Loop.observe`."""

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        motion = self._motion
        return time_ticks(
            Simulator(self._system), len(motion), motion.period_s, paced=self._paced
        )


class _EmptySystem(LeafSystem):
    """A discrete state that an update leaves as it is."""

    def __init__(self, period_s: float):
        super().__init__()
        self.DeclareDiscreteState(1)
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        """Does nothing."""
