"""Refuses, with a reason, systems that an analysis cannot describe.

Preconditions are checked first. Errors of Drake become errors that a caller can catch
and act on: pydrake turns a failed C++ assertion into `SystemExit`, which passes every
`except Exception` and ends the interpreter; any other failure is a `RuntimeError` that
says what failed inside Drake, not what to change.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from pydrake.autodiffutils import AutoDiffXd
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import (
    InitializeParams,
    ResetIntegratorFromFlags,
    Simulator,
)
from pydrake.systems.framework import Context, System

from drake_haptics.analysis.diagram_systems import Timing, calc_path
from drake_haptics.common.subsystems import walk_leaves
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.common.value_checks import check_positive


def check_system_and_context(diagram: System, context: Context) -> None:
    """Raises an error unless the arguments are a system and one of its contexts.

    Raises:
        TypeError: An argument has the wrong type.
        RuntimeError: The context belongs to another system.
    """
    require_kinds(
        "BuildHapticDiagram returns one in .diagram", diagram=(diagram, System)
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
    """Raises a ValueError that names a system without an AutoDiffXd twin.

    The attribute `no_derivatives` of such a system says why, and what to do.
    """
    found = [
        leaf
        for leaf in walk_leaves(system)
        if hasattr(leaf, "no_derivatives")
        or not leaf.get_system_scalar_converter().IsConvertible[AutoDiffXd, float]()
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
        timings: The timings that `find_timings` found.
        period_s: The period, s; only needed for a system without periodic updates.

    Raises:
        ValueError: There are several periods or an offset; there is no period and
            `period_s` is not given; or `period_s` differs or is not positive.
    """
    if period_s is not None:
        check_positive(period_s=period_s)
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
            " period cannot hold them; use calc_monodromy over their common period"
        )
    late = [timing for timing in timings if timing.offset_s != 0.0]
    if late:
        raise ValueError(
            f"updates with an offset, {_list_timings(late)}: set the offset to 0, or"
            " use calc_monodromy"
        )
    found = timings[0].period_s
    if period_s is not None and not math.isclose(period_s, found, rel_tol=1e-9):
        raise ValueError(
            f"period_s is {period_s:g}, but {timings[0].system} is updated every"
            f" {found:g} s: leave period_s out"
        )
    return found


def check_events(system: System, context: Context, period_s: float) -> None:
    """Raises ValueError for per-step updates and unrestricted updates.

    pydrake does not list a system's events. So a clone is simulated from time 0, when
    every periodic event without an offset is due, in two steps within a period, in
    which none is due; Drake counts what ran. Publish events run, too. An unrestricted
    update with a larger offset is not found.

    Args:
        system: A system whose periodic discrete updates have one period and no offset.
        context: Its root context; only a clone is simulated.
        period_s: The period, s.
    """
    clone = context.Clone()
    clone.SetTime(0.0)
    simulator = Simulator(system, clone)
    # The motion does not matter here, so the cheapest integrator will do.
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
    # Systems of Drake have no such events.
    names = [
        calc_path(system, leaf)
        for leaf in walk_leaves(system)
        if not type(leaf).__module__.startswith("pydrake.")
    ]
    return f"Look among {', '.join(names)}." if names else ""


def _list_timings(timings: Sequence[Timing]) -> str:
    return ", ".join(
        f"{t.period_s:g} s"
        + (f" from {t.offset_s:g} s on" if t.offset_s else "")
        + f" ({t.system})"
        for t in timings
    )


# Texts of Drake's errors (1.51 to 1.58), and what they mean for an analysis.
_REASONS = (
    (
        "has_only_continuous_state",
        "Drake linearizes only systems that are all continuous or have one discrete"
        " group, one period, no offset and no abstract state: use linearize_sampled,"
        " which names the part that is in the way",
    ),
    (
        "does not support scalar conversion",
        "a system has no AutoDiffXd twin: write it as a TemplateSystem",
    ),
    (
        "more than one periodic timing",
        "the diagram updates at several rates: use calc_monodromy",
    ),
    (
        "no periodic discrete update events",
        "no state is updated periodically: linearize a continuous system with Drake's"
        " Linearize(system, context), or give period_s for the map over that time",
    ),
    (
        "wrong value type",
        "a port's value has another type than its reader asks for: an abstract port"
        " carries doubles where AutoDiffXd is needed, or is used as a vector port",
    ),
    (
        "only supports vector-valued input ports",
        "the input port is abstract: name a vector port, or none",
    ),
    (
        "must be copied, and cannot be referenced",
        "a system reads or writes numbers by reference, which AutoDiffXd does not"
        " allow: use CopyToVector(), set_value() or SetFromVector()",
    ),
    (
        "'hunt_crossley_dissipation'",
        "point contact of a continuous MultibodyPlant has no derivatives in Drake:"
        " remove the proximity role, or use a discrete plant",
    ),
    (
        "Penetration queries between shapes",
        "Drake's own point contact acts between two bodies and has no derivatives for"
        " their shapes: let AddHapticRendering render them too, give them hydroelastic"
        " properties, or part them by a collision filter",
    ),
    (
        "is not connected",
        "an input is open: connect it, or fix its value in the context",
    ),
    (
        "is neither connected nor fixed",
        "an input is open: connect it, or fix its value in the context",
    ),
    (
        "inconsistent, non-zero numbers of derivatives",
        "a system makes AutoDiffXd numbers of its own instead of carrying its inputs'"
        " derivatives on",
    ),
)
_ASSERTION = re.compile(r"(Failure|abort\w*): |Failure at ")


@contextmanager
def explain_drake_errors(doing: str) -> Iterator[None]:
    """Raises a `ValueError` with the reason if Drake would end the program.

    It is also a decorator. A `SystemExit` that is not Drake's passes, as does a
    `RuntimeError` whose text is unknown, since it is probably the user's.

    Args:
        doing: Description of the work for the message, such as "linearizing the
            diagram".

    Raises:
        ValueError: Drake failed; the message says what to change, then quotes Drake.
    """
    try:
        yield
    except SystemExit as error:
        if not _ASSERTION.match(str(error.code)):
            raise
        raise ValueError(_explain(doing, str(error.code))) from error
    except RuntimeError as error:
        if not _find_reason(str(error)):
            raise
        raise ValueError(_explain(doing, str(error))) from error


def _find_reason(text: str) -> str:
    return next((reason for known, reason in _REASONS if known in text), "")


def _explain(doing: str, text: str) -> str:
    reason = _find_reason(text) or "a condition of Drake's does not hold"
    return f"{doing}: {reason}. Drake says: {text.strip()}"
