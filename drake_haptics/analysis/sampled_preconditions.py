"""Refuses, with a reason, what a linear map over one period cannot describe."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pydrake.autodiffutils import AutoDiffXd
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import (
    InitializeParams,
    ResetIntegratorFromFlags,
    Simulator,
)
from pydrake.systems.framework import Context, System

from drake_haptics.analysis.diagram_systems import (
    Timing,
    calc_path,
    walk_leaves,
)
from drake_haptics.common.type_checks import require_kinds


def check_system_and_context(diagram: System, context: Context) -> None:
    """Raises unless they are a system and a context of it.

    Raises:
        TypeError: One of them is of another kind.
        RuntimeError: The context is of another system.
    """
    require_kinds(
        "of what BuildHapticDiagram gives it is .diagram", diagram=(diagram, System)
    )
    require_kinds(
        "Simulator.get_context() is one, as is diagram.CreateDefaultContext()",
        context=(context, Context),
    )
    diagram.ValidateContext(context)


def check_abstract_state(system: System) -> None:
    """Raises ValueError if a system has state that is not numbers."""
    for leaf in walk_leaves(system):
        if leaf.num_abstract_states() == 0:
            continue
        name = calc_path(system, leaf)
        if isinstance(leaf, MultibodyPlant) and leaf.has_sampled_output_ports():
            raise ValueError(
                f"the discrete MultibodyPlant {name} samples its output ports, which"
                " hides state: call SetUseSampledOutputPorts(False) before Finalize(),"
                " or set use_sampled_output_ports=False in its MultibodyPlantConfig"
            )
        raise ValueError(
            f"{name} has abstract state, which has no derivative: keep it outside the"
            " diagram, or declare the state as numbers"
        )


def check_conversion(system: System) -> None:
    """Raises ValueError if a system has no AutoDiffXd twin, and names it.

    A system that can have none says in its `no_derivatives` why, and what to do.
    """
    found = [
        leaf
        for leaf in walk_leaves(system)
        if not leaf.get_system_scalar_converter().IsConvertible[AutoDiffXd, float]()
    ]
    reasons = [
        f"{calc_path(system, leaf)} {leaf.no_derivatives}"
        for leaf in found
        if hasattr(leaf, "no_derivatives")
    ]
    if reasons:
        raise ValueError(f"no derivatives: {'; '.join(reasons)}")
    lacking = sorted(
        {f"{calc_path(system, leaf)} ({type(leaf).__name__})" for leaf in found}
    )
    if lacking:
        raise ValueError(
            f"no derivatives: {', '.join(lacking)} does not convert to AutoDiffXd:"
            " define it with TemplateSystem, T_list=[float, AutoDiffXd], or keep it"
            " outside the diagram"
        )


def find_period(timings: Sequence[Timing], period_s: float | None) -> float:
    """Returns the one period T of a system, s.

    Args:
        timings: What `find_timings` found.
        period_s: The period, s, needed for a system without periodic updates.

    Raises:
        ValueError: There are several periods, an offset, none and `period_s` is not
            given, or `period_s` is another one or not positive.
    """
    if period_s is not None:
        check_positive("period_s", period_s)
    if not timings:
        if period_s is None:
            raise ValueError(
                "no state is updated periodically: linearize a continuous system with"
                " Drake's Linearize(system, context), or give period_s for the map"
                " over that time"
            )
        return period_s
    if len({timing.period_s for timing in timings}) > 1:
        raise ValueError(
            f"several periods, {_list_timings(timings)}: one linear map over one"
            " period cannot hold them; use monodromy over their common period"
        )
    late = [timing for timing in timings if timing.offset_s != 0.0]
    if late:
        raise ValueError(
            f"updates with an offset, {_list_timings(late)}: set the offset to 0, or"
            " use monodromy"
        )
    found = timings[0].period_s
    if period_s is not None and not math.isclose(period_s, found, rel_tol=1e-9):
        raise ValueError(
            f"period_s is {period_s:g}, but {timings[0].system} is updated every"
            f" {found:g} s: leave period_s out"
        )
    return found


def check_positive(name: str, value: float) -> None:
    """Raises ValueError if a number is not positive and finite."""
    if not (value > 0.0 and math.isfinite(value)):
        raise ValueError(f"{name} must be positive, is {value}")


def check_events(system: System, context: Context, period_s: float) -> None:
    """Raises ValueError for per-step updates and unrestricted updates.

    pydrake does not list a system's events, so a clone is simulated from time 0, when
    every periodic event without an offset is due, for two parts of a period, in which
    none is; Drake's own counters tell what ran. Publish events run too. An unrestricted
    update that has an offset of more than that is not seen.

    Args:
        system: A system whose periodic discrete updates have one period, no offset.
        context: Its root context; only a clone is simulated.
        period_s: The period, s.
    """
    clone = context.Clone()
    clone.SetTime(0.0)
    simulator = Simulator(system, clone)
    # The state's motion does not matter here, so the cheapest integrator will do.
    ResetIntegratorFromFlags(simulator, "explicit_euler", period_s)
    simulator.Initialize(InitializeParams(suppress_initialization_events=True))
    simulator.AdvancePendingEvents()
    before = simulator.get_num_discrete_updates()
    simulator.AdvanceTo(period_s / 3.0)
    simulator.AdvanceTo(period_s / 1.5)
    if simulator.get_num_unrestricted_updates():
        raise ValueError(
            "an unrestricted update, which may change any state and has no derivative,"
            " would be ignored: declare a discrete update instead, or keep the system"
            f" outside the diagram. {_say_suspects(system)}"
        )
    if simulator.get_num_discrete_updates() != before:
        raise ValueError(
            "a discrete update runs at every step, so that its effect depends on the"
            " integrator's steps: declare a periodic update instead."
            f" {_say_suspects(system)}"
        )


def _say_suspects(system: System) -> str:
    names = [calc_path(system, leaf) for leaf in walk_leaves(system) if _is_own(leaf)]
    return f"Look among {', '.join(names)}." if names else ""


def _is_own(leaf: System) -> bool:
    """Whether a system is written by a user, as Drake's own do nothing of the kind."""
    return not type(leaf).__module__.startswith("pydrake.")


def _list_timings(timings: Sequence[Timing]) -> str:
    return ", ".join(
        f"{t.period_s:g} s"
        + (f" from {t.offset_s:g} s on" if t.offset_s else "")
        + f" ({t.system})"
        for t in timings
    )
