"""Runs loops in Drake's Simulator: times each tick, and observes the course."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import (
    Context,
    DiscreteValues,
    EventStatus,
    LeafSystem,
    OutputPort,
)

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.benchmark.loop.problem import LoopCourse, LoopProblem
from drake_haptics.evaluation.measuring.timing import steady_memory


def time_ticks(
    simulator: Simulator,
    ticks: int,
    period_s: float,
    *,
    paced: bool,
    between: Callable[[int], None] = lambda tick: None,
) -> np.ndarray:
    """Returns the time (ticks,) of each tick, s.

    Neither waiting nor `between` is part of a tick.

    Args:
        simulator: Simulator at time 0, not initialized.
        ticks: Number of ticks.
        period_s: Period of the ticks, s.
        paced: Whether each tick waits for the clock, as for a device.
        between: Called after each tick with the number of the next one.
    """
    begins: list[float] = []
    ends: list[float] = []
    clock = time.perf_counter
    pace = RealTimePacer(period_s) if paced else None

    def note(context: Context) -> EventStatus:
        ends.append(clock())
        between(len(ends))
        if pace is not None:
            pace.wait()
        begins.append(clock())
        return EventStatus.Succeeded()

    with steady_memory():
        simulator.Initialize()
        simulator.set_monitor(note)
        begins.append(clock())
        simulator.AdvanceTo((ticks - 0.5) * period_s)
    # The last tick ends with the run.
    return (np.array(ends) - begins[: len(ends)])[:ticks]


class SimulatedLoop(ABC):
    """A loop in Drake's Simulator."""

    def __init__(self, problem: LoopProblem, *, paced: bool = False):
        self._problem = problem
        self._paced = paced

    @abstractmethod
    def make_simulator(self) -> Simulator:
        """Returns a simulator at the beginning of the motion."""

    def time(self) -> np.ndarray:
        """See `Loop.time`."""
        motion = self._problem.motion
        return time_ticks(
            self.make_simulator(), len(motion), motion.period_s, paced=self._paced
        )


def observe_ticks(
    problem: LoopProblem, simulator: Simulator, pose: OutputPort, contacts: OutputPort
) -> LoopCourse:
    """Returns the course of a loop in a run that is not timed.

    The simulator is at the beginning of the motion. The pose begins with the tool's [qw
    qx qy qz x y z], m; the contacts are a `ContactSet`.
    """
    root = simulator.get_context()
    pose_context = pose.get_system().GetMyContextFromRoot(root)
    contacts_context = contacts.get_system().GetMyContextFromRoot(root)
    rows: list[np.ndarray] = []
    counts: list[tuple[int, float]] = []

    def note(context: Context) -> None:
        rows.append(np.array(pose.Eval(pose_context)[:7]))
        found = contacts.Eval(contacts_context)
        counts.append((len(found), min(found.distance.tolist(), default=0.0)))

    n = len(problem.motion)
    simulator.Initialize()
    note(root)
    simulator.set_monitor(note)
    simulator.AdvanceTo((n - 0.5) * problem.motion.period_s)
    X_WT, (num_contacts, nearest_m) = np.array(rows[:n]), np.array(counts[:n]).T
    force_N = problem.spring_force(X_WT[:, 4:])
    return LoopCourse(X_WT, num_contacts.astype(int), nearest_m, force_N)


class EmptyLoop(SimulatedLoop):
    """A loop without a tool: Drake's Simulator with one call of Python per tick."""

    def observe(self) -> None:
        """Has no tool; see `Loop.observe`."""

    def make_simulator(self) -> Simulator:
        """Returns a simulator of one Python system that does nothing."""
        return Simulator(_EmptySystem(self._problem.motion.period_s))


class _EmptySystem(LeafSystem):
    """A discrete state that its update does not change."""

    def __init__(self, period_s: float):
        super().__init__()
        self.DeclareDiscreteState(1)
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        """Does nothing."""
