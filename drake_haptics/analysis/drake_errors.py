"""Drake's refusals in an analysis, said as errors that a caller can catch and act on.

pydrake turns a failed C++ assertion into `SystemExit`, which passes every `except
Exception` and ends the interpreter; each other is a `RuntimeError` that tells what
failed inside Drake, not what to change.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

# What Drake says (1.51 to 1.58), and what it means for somebody who analyses a diagram.
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
        "the diagram updates at several rates: use monodromy",
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
    """Raises a `ValueError` with the reason where Drake would end the program.

    Also a decorator. A `SystemExit` that is not Drake's passes, as does a
    `RuntimeError` whose text is not known here: it is the user's own.

    Args:
        doing: What failed, for the message, as "linearizing the diagram".

    Raises:
        ValueError: Drake refused; names what to change, then quotes Drake.
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
