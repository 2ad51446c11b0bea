"""Linearizes a diagram with several rates over their common period."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from pydrake.autodiffutils import AutoDiffXd, ExtractValue, InitializeAutoDiff
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import (
    InitializeParams,
    ResetIntegratorFromFlags,
    Simulator_,
)
from pydrake.systems.framework import Context, System

from drake_haptics.analysis.derivative_check import (
    calc_sizes,
    check_derivatives,
    move_beside,
)
from drake_haptics.analysis.diagram_systems import (
    AutoDiffClone,
    Timing,
    find_state_layout,
    find_timings,
)
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.modes import PeriodMap, check_return
from drake_haptics.analysis.preconditions import (
    check_abstract_state,
    check_conversion,
    check_system_and_context,
    explain_drake_errors,
)
from drake_haptics.analysis.sampled_map import extract_gradient, get_state, set_state
from drake_haptics.common.subsystems import walk_leaves
from drake_haptics.common.value_checks import check_positive

# Periods are taken for fractions of a second with denominators up to this.
_LARGEST_DENOMINATOR = 10**7
# A longer common period, in shortest periods, is probably an accident of rounding.
_MOST_PERIODS = 10_000
# Times that differ by less than this part of a period are equal.
_SAME_TIME = 1e-9


def find_hyperperiod(
    timings: Sequence[Timing], hyperperiod_s: float | None = None
) -> float:
    """Returns the smallest common multiple of all periods, s, or checks a given one.

    Args:
        timings: Timings of all periodic updates.
        hyperperiod_s: Time to return if it is a multiple of all periods, s.

    Raises:
        ValueError: `hyperperiod_s` is not a common period; or it is not given, and
            there are no periods, or no common multiple below 10000 of the shortest.
    """
    periods = sorted({timing.period_s for timing in timings})
    if hyperperiod_s is not None:
        check_positive(hyperperiod_s=hyperperiod_s)
        for period in periods:
            count = hyperperiod_s / period
            if round(count) < 1 or abs(count - round(count)) > _SAME_TIME * count:
                raise ValueError(
                    "hyperperiod_s must be a multiple of all periods, but"
                    f" {hyperperiod_s:g} s is {count:g} times {period:g} s"
                )
        return hyperperiod_s
    if not periods:
        raise ValueError("hyperperiod_s must be given: nothing is updated periodically")
    exact = [Fraction(p).limit_denominator(_LARGEST_DENOMINATOR) for p in periods]
    found = float(
        Fraction(
            math.lcm(*(fraction.numerator for fraction in exact)),
            math.gcd(*(fraction.denominator for fraction in exact)),
        )
    )
    rational = all(
        abs(float(fraction) - period) <= _SAME_TIME * period
        for fraction, period in zip(exact, periods, strict=True)
    )
    if not rational or found > _MOST_PERIODS * periods[0]:
        raise ValueError(
            f"the periods {', '.join(f'{p:g}' for p in periods)} s have no common"
            f" multiple below {_MOST_PERIODS} of the shortest: give hyperperiod_s, or"
            " change a rate"
        )
    return found


def snap_to_update(time_s: float, timings: Sequence[Timing]) -> float:
    """Returns the first of the updates that are at a time up to round-off, s.

    Drake multiplies period by count, so that 3 · 0.1 s is after 0.3 s: a simulation
    until the later of the two would also perform the update at the earlier one.
    """
    near = [time_s]
    for timing in timings:
        count = round((time_s - timing.offset_s) / timing.period_s)
        due = timing.offset_s + count * timing.period_s
        if abs(due - time_s) <= _SAME_TIME * timing.period_s:
            near.append(due)
    return min(near)


# Default number of integration steps in the shortest period.
_STEPS = 10


@dataclass(frozen=True)
class Monodromy(PeriodMap):
    """x⁺ = A x about an equilibrium over one hyperperiod, from a simulation.

    Attributes:
        step_s: Step of the integrator, s.
    """

    step_s: float


@explain_drake_errors("simulating one hyperperiod with derivatives")
@on_one_blas_thread
def calc_monodromy(
    diagram: System,
    context: Context,
    hyperperiod_s: float | None = None,
    *,
    step_s: float | None = None,
    tolerance: float = 1e-8,
) -> Monodromy:
    """Linearizes a system over one hyperperiod, a multiple of all its periods.

    A simulation in AutoDiffXd with fixed steps of a third-order Runge-Kutta method
    gives ∂x(t + H)/∂x(t); its eigenvalues are the Floquet multipliers. Use it for
    several rates or offsets, and for discrete plants that sample their output ports.
    Such plants step before the discrete updates of the same time, and their samples of
    the last step count as functions of the state. For one rate `linearize_sampled` is
    exact and faster. All events run, including publish events; time continues from that
    of the context.

    Args:
        diagram: Any system that converts to AutoDiffXd.
        context: Its root context, at an equilibrium; only clones are simulated.
        hyperperiod_s: H, a multiple of all periods, s. Defaults to the smallest.
        step_s: Step of the integrator, s. Defaults to a tenth of the shortest period.
        tolerance: Bound of `equilibrium_residual`.

    Raises:
        ValueError: The state does not return; H is not a multiple of all periods, or is
            not given and there is no such multiple; a system has abstract state, does
            not convert, or loses derivatives; or Drake refuses the diagram.
    """
    check_system_and_context(diagram, context)
    check_positive(tolerance=tolerance)
    abstract = [leaf for leaf in walk_leaves(diagram) if leaf.num_abstract_states()]
    if not all(map(_is_sampled_plant, abstract)):
        check_abstract_state(diagram)
    check_conversion(diagram)
    timings = find_timings(diagram, context) + _find_sampled_plants(diagram)
    H = find_hyperperiod(timings, hyperperiod_s)
    shortest = min((timing.period_s for timing in timings), default=H)
    step_s = shortest / _STEPS if step_s is None else step_s
    check_positive(step_s=step_s)
    start = snap_to_update(context.get_time(), timings)
    end = snap_to_update(start + H, timings)
    x = get_state(context)
    if len(x) == 0:
        raise ValueError("the system has no state: there is nothing to linearize")
    layout = find_state_layout(diagram)

    twin = AutoDiffClone(diagram)

    def differentiate(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns the state after a hyperperiod, and its derivative."""
        clone = context.Clone()
        set_state(clone, x)
        twin.follow(clone)
        seeds = InitializeAutoDiff(x).ravel()
        final = _simulate(
            AutoDiffXd, twin.system, twin.context.Clone(), seeds, (start, end), step_s
        )
        values = ExtractValue(final.reshape(-1, 1)).ravel()
        return values, extract_gradient(final, len(x))

    returned, A = differentiate(x)
    residual = check_return(x, returned - x, layout.names, tolerance)
    beside = move_beside(x)
    check_derivatives(
        lambda step: _simulate(
            float, diagram, context.Clone(), beside + step, (start, end), step_s
        ),
        differentiate(beside)[1],
        calc_sizes(beside),
        layout.names,
        layout.names,
    )
    return Monodromy(
        A=A,
        period_s=H,
        state_names=layout.names,
        state=x,
        quaternions=layout.quaternions,
        equilibrium_residual=residual,
        step_s=step_s,
    )


def _simulate(
    scalar: Any,
    system: System,
    context: Context,
    x: np.ndarray,
    span_s: tuple[float, float],
    step_s: float,
) -> np.ndarray:
    """Returns the state (n,) just before the updates at the end, in a scalar type."""
    context.SetTime(span_s[0])
    set_state(context, x)
    simulator = Simulator_[scalar](system, context)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", scalar(step_s))
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    simulator.Initialize(InitializeParams(suppress_initialization_events=True))
    simulator.AdvanceTo(span_s[1])
    return get_state(context)


def _is_sampled_plant(leaf: System) -> bool:
    return (
        isinstance(leaf, MultibodyPlant)
        and leaf.time_step() > 0.0
        and leaf.has_sampled_output_ports()
    )


def _find_sampled_plants(diagram: System) -> list[Timing]:
    """Returns the timings of plants whose update Drake does not count as discrete."""
    return [
        Timing(leaf.time_step(), 0.0, leaf.get_name())
        for leaf in walk_leaves(diagram)
        if _is_sampled_plant(leaf)
    ]
