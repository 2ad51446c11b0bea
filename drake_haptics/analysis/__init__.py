"""How stable a diagram is: linear maps over a period, modes, bounds and maps of them.

Works on any Drake diagram. The names are imported when they are first asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drake_haptics.analysis.drake_errors import explain_drake_errors
    from drake_haptics.analysis.sampled_linearization import (
        SampledLinearization,
        linearize_sampled,
    )

__all__ = [
    "SampledLinearization",
    "explain_drake_errors",
    "linearize_sampled",
]

_MODULE_OF = {
    "SampledLinearization": "sampled_linearization",
    "explain_drake_errors": "drake_errors",
    "linearize_sampled": "sampled_linearization",
}


def __getattr__(name: str) -> object:
    """Imports a public name from its module when it is first asked for."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    """Lists the public names, for completion."""
    return sorted(__all__)
