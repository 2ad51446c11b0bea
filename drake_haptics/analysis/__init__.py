"""How stable a diagram is: linear maps over a period, modes, bounds and maps of them.

Works on any Drake diagram. The names are imported when they are first asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drake_haptics.analysis.drake_errors import explain_drake_errors
    from drake_haptics.analysis.equilibrium import Equilibrium, find_equilibrium
    from drake_haptics.analysis.mode_plot import plot_poles
    from drake_haptics.analysis.modes import Mode, ModeKind, find_modes
    from drake_haptics.analysis.multirate import Monodromy, monodromy
    from drake_haptics.analysis.sampled_linearization import (
        SampledLinearization,
        linearize_sampled,
    )

__all__ = [
    "Equilibrium",
    "Mode",
    "ModeKind",
    "Monodromy",
    "SampledLinearization",
    "explain_drake_errors",
    "find_equilibrium",
    "find_modes",
    "linearize_sampled",
    "monodromy",
    "plot_poles",
]

_MODULE_OF = {
    "Equilibrium": "equilibrium",
    "Mode": "modes",
    "ModeKind": "modes",
    "Monodromy": "multirate",
    "SampledLinearization": "sampled_linearization",
    "explain_drake_errors": "drake_errors",
    "find_equilibrium": "equilibrium",
    "find_modes": "modes",
    "linearize_sampled": "sampled_linearization",
    "monodromy": "multirate",
    "plot_poles": "mode_plot",
}


def __getattr__(name: str) -> object:
    """Imports a public name from its module when it is first asked for."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    """Lists the public names, for completion."""
    return sorted(__all__)
