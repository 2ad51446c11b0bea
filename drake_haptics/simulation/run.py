"""Runs a haptic diagram tick by tick and measures it."""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable
from contextlib import nullcontext

import numpy as np
from pydrake.systems.analysis import (
    InitializeParams,
    ResetIntegratorFromFlags,
    Simulator,
)
from pydrake.systems.framework import Context, EventStatus

from drake_haptics.common.real_time import RealTimePacer, realtime_priority
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.contact_law import make_overlap_warning
from drake_haptics.scene.validation import make_depth_warning, warn_caller
from drake_haptics.simulation.energy import EnergyLedger
from drake_haptics.simulation.statistics import RunStatistics

_MADE_BY = "BuildHapticDiagram(scene) returns one"


class RunError(RuntimeError):
    """A run was stopped because a value was no longer finite.

    Attributes:
        statistics: Statistics of the run until then.
    """

    def __init__(self, message: str, statistics: RunStatistics):
        super().__init__(message)
        self.statistics = statistics


def make_simulator(haptic: HapticDiagram, context: Context | None = None) -> Simulator:
    """Returns a simulator that integrates one step per tick.

    The step is fixed and of second order: the stiffest motion of a shipped arm in
    a shipped grip is slow against a tick (tests/simulation/test_run.py).

    Args:
        haptic: Return value of `BuildHapticDiagram`.
        context: Initial context, which the simulator then owns. Defaults to time 0.
    """
    require_kinds(_MADE_BY, haptic=(haptic, HapticDiagram))
    simulator = Simulator(haptic.diagram, context)
    ResetIntegratorFromFlags(simulator, "runge_kutta2", haptic.period_s)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    return simulator


def run(
    haptic: HapticDiagram,
    duration_s: float | None = None,
    *,
    pace: RealTimePacer | None = None,
    energy: bool = False,
    on_tick: Callable[[Context], bool | None] | None = None,
    context: Context | None = None,
    statistics: RunStatistics | None = None,
) -> RunStatistics:
    """Runs a scene and measures every tick.

    A run can continue an earlier one: pass its statistics and the context in which it
    ended, of the same diagram or transferred to another
    (`drake_haptics.transfer_context`).

    Args:
        haptic: Return value of `BuildHapticDiagram`.
        duration_s: Simulated time, s, rounded up to whole ticks. Defaults to forever.
        pace: Pacer that waits for each tick, so that simulated time is clock time; a
            device needs it. The run then requests real-time priority. Defaults to
            running as fast as possible.
        energy: Whether to keep an `EnergyLedger`, which takes about 10 µs per tick.
            Only for a simulated device: the motion of any other between two readings is
            unknown.
        on_tick: Function that is called after every tick with the diagram's context, in
            which it may change only parameters, as
            `drake_haptics.simulation.live_values` does. Its time counts as part of the
            tick. The run ends if it returns True.
        context: Context to continue from, which becomes the simulator's and is
            initialized only at time 0. Defaults to the scene's start.
        statistics: Statistics to add to. Defaults to new ones. They are filled tick by
            tick, so that they are valid even if an error or Ctrl-C ends the run.

    Returns:
        Statistics of the run.

    Warns:
        SceneWarning: A contact was deeper than ten tolerances, or under `contact.law:
            constraint` penetrated at all, for the first time in these statistics.

    Raises:
        ValueError: The diagram is part of another one, `duration_s` is negative, the
            statistics have another tick, or `energy` is set but the device is not
            simulated or the statistics already have ticks.
        RunError: The tool or the arm has a pose or velocity that is not finite.
        TypeError: An argument has the wrong type; the message names it.
        KeyboardInterrupt: Ctrl-C was pressed.
    """
    require_kinds(_MADE_BY, haptic=(haptic, HapticDiagram))
    require_kinds(
        duration_s=(duration_s, float | None),
        pace=(pace, RealTimePacer | None),
        on_tick=(on_tick, Callable | None),
        statistics=(statistics, RunStatistics | None),
    )
    if haptic.diagram.GetSystemPathname().count("::") > 1:
        raise ValueError(
            "haptic: its diagram is part of another one: advance that by a Simulator,"
            " or call BuildHapticDiagram again for a run"
        )
    # Drake aborts the program if the end time is in the past.
    if duration_s is not None and not duration_s >= 0.0:
        raise ValueError(f"duration_s must not be negative, is {duration_s}")
    if energy and haptic.backend is not None:
        raise ValueError("energy can be recorded for a simulated device only")
    if energy and statistics is not None and statistics.ticks:
        raise ValueError("energy can be recorded only from the first tick of a run")
    if statistics is not None and not math.isclose(
        statistics.period_s, haptic.period_s
    ):
        raise ValueError(
            f"statistics: have ticks of {statistics.period_s:g} s, and those of the run"
            f" are of {haptic.period_s:g} s: make them with haptic.period_s"
        )
    simulator = make_simulator(haptic, context)
    ledger = EnergyLedger(haptic.loop, simulator.get_context()) if energy else None
    if statistics is None:
        statistics = RunStatistics(haptic.period_s)
    if pace is not None:
        statistics.follow(pace)
    if ledger is not None:
        statistics.book(ledger)
    before_m = statistics.max_penetration_m
    end_s = math.inf
    if duration_s is not None and duration_s < math.inf:
        end_s = _find_end(simulator.get_context().get_time(), duration_s, haptic)
    measure = _make_measure(haptic, simulator.get_context(), statistics, ledger)
    # Collecting garbage over all of pydrake's objects takes many ticks, so they are
    # frozen. A run that continues another has no time for a collection.
    if context is None:
        gc.collect()
    gc.freeze()
    try:
        simulator.Initialize(
            InitializeParams(
                suppress_initialization_events=simulator.get_context().get_time() > 0.0
            )
        )
        if ledger is not None:
            ledger.add()
        simulator.set_monitor(_make_monitor(haptic, measure, on_tick, pace))
        with nullcontext() if pace is None else realtime_priority():
            simulator.AdvanceTo(end_s)
    except FloatingPointError as error:
        time_s = simulator.get_context().get_time()
        raise RunError(f"stopped at {time_s:.4f} s: {error}", statistics) from error
    except ValueError:
        # What computes with a lost tool before the tick ends refuses its state.
        measure(simulator.get_context(), 0.0, False)
        raise
    finally:
        gc.unfreeze()
        describe = _make_depth_warner(haptic, simulator.get_context())
        warning = describe(statistics.max_penetration_m)
        if warning and not describe(before_m):
            warn_caller(warning)
    return statistics


def _make_depth_warner(haptic: HapticDiagram, root: Context) -> Callable[[float], str]:
    """Returns a function that warns of a depth (m) beyond the law of contact."""
    penalty = haptic.loop.penalty
    if penalty is None:
        return make_overlap_warning
    tolerance_m = penalty.read_tolerance(root)
    return lambda depth_m: make_depth_warning(depth_m, tolerance_m)


def _find_end(start_s: float, duration_s: float, haptic: HapticDiagram) -> float:
    """Returns the end time of a run, s: the end of a tick."""
    # Round-off must not make another tick.
    ticks = math.ceil((start_s + duration_s) / haptic.period_s - 1e-6)
    return max(start_s, ticks * haptic.period_s)


def _make_monitor(
    haptic: HapticDiagram,
    measure: Callable[[Context, float, bool], None],
    on_tick: Callable[[Context], bool | None] | None,
    pace: RealTimePacer | None,
) -> Callable[[Context], EventStatus | None]:
    """Returns a function that the simulator calls after each step of the tool."""
    start_s = time.perf_counter()
    step_s = haptic.loop.haptic_tool.step_period_s
    steps_per_tick = round(haptic.period_s / step_s)

    def monitor(context: Context) -> EventStatus | None:
        nonlocal start_s
        now_s = time.perf_counter()
        ends_tick = (
            steps_per_tick == 1
            or round(context.get_time() / step_s) % steps_per_tick == 0
        )
        measure(context, now_s - start_s, ends_tick)
        if not ends_tick:
            return None
        start_s = now_s
        if on_tick is not None and on_tick(context):
            return EventStatus.ReachedTermination(
                haptic.diagram, "on_tick ends the run"
            )
        if pace is not None:
            now_s = time.perf_counter()
            pace.wait()
            # Waiting is not part of a tick.
            start_s += time.perf_counter() - now_s
        return None

    return monitor


def _make_measure(
    haptic: HapticDiagram,
    root: Context,
    statistics: RunStatistics,
    ledger: EnergyLedger | None,
) -> Callable[[Context, float, bool], None]:
    """Returns a function that records a step, and a tick's values if it ends one."""
    loop = haptic.loop
    tool_context = loop.haptic_tool.GetMyContextFromRoot(root)
    hold = loop.device.GetSubsystemByName("rendered_force_hold")
    hold_context = hold.GetMyContextFromRoot(root)
    contacts_port = loop.found_contacts
    contacts_context = contacts_port.get_system().GetMyContextFromRoot(root)
    shed_context = (
        None
        if loop.load_shedding is None
        else loop.load_shedding.GetMyContextFromRoot(root)
    )
    clusters_port = loop.clusters
    clusters_context = clusters_port.get_system().GetMyContextFromRoot(root)
    chain_port = None
    if loop.penalty is not None and loop.contact_query.HasOutputPort("contact_chain"):
        chain_port = loop.contact_query.GetOutputPort("contact_chain")

    def summarize(tool_state: np.ndarray) -> tuple[int, int, float, float]:
        """Numbers of contacts and clusters, least distance, time of the query."""
        if chain_port is not None:
            return chain_port.Eval(contacts_context).summarize(tool_state)
        contacts = contacts_port.Eval(contacts_context)
        return (
            len(contacts),
            len(clusters_port.Eval(clusters_context)),
            contacts.least_distance,
            contacts.query_seconds,
        )

    def measure(context: Context, tick_s: float, ends_tick: bool) -> None:
        shown = hold_context.get_discrete_state_vector().value().tolist()
        # A handle that is not finite makes the tool's state not finite, too.
        tool_state = tool_context.get_discrete_state(0).value()
        if not math.isfinite(sum(tool_state.tolist())):
            # A tool whose state is not finite has no contacts.
            statistics.add(tick_s, 0.0, 0, 0, math.inf, shown)
            raise RunError(
                f"stopped at {context.get_time():.4f} s: the tool's state is not"
                " finite",
                statistics,
            )
        if ends_tick:
            # These are cached for the next tick, so that nothing is computed twice.
            contacts, clusters, least_m, query_s = summarize(tool_state)
            statistics.add(tick_s, query_s, contacts, clusters, least_m, shown)
            if shed_context is not None:
                shed = shed_context.get_discrete_state_vector().value()[0]
                statistics.add_shed(shed)
        if ledger is not None:
            ledger.add()

    return measure
