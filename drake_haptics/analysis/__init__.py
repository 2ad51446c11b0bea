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
    from drake_haptics.analysis.study import run_study
    from drake_haptics.analysis.study_error import StudyError
    from drake_haptics.analysis.study_pool import SerialExecutor
    from drake_haptics.analysis.study_progress import StudyProgress
    from drake_haptics.analysis.z_width_map import ZWidth, z_width
    from drake_haptics.analysis.z_width_plot import HeldBounds

__all__ = [
    "Equilibrium",
    "HeldBounds",
    "Mode",
    "ModeKind",
    "Monodromy",
    "SampledLinearization",
    "SerialExecutor",
    "StudyError",
    "StudyProgress",
    "ZWidth",
    "explain_drake_errors",
    "find_equilibrium",
    "find_modes",
    "linearize_sampled",
    "monodromy",
    "plot_poles",
    "run_study",
    "z_width",
]

_MODULE_OF = {
    "Equilibrium": "equilibrium",
    "HeldBounds": "z_width_plot",
    "Mode": "modes",
    "ModeKind": "modes",
    "Monodromy": "multirate",
    "SampledLinearization": "sampled_linearization",
    "SerialExecutor": "study_pool",
    "StudyError": "study_error",
    "StudyProgress": "study_progress",
    "ZWidth": "z_width_map",
    "explain_drake_errors": "drake_errors",
    "find_equilibrium": "equilibrium",
    "find_modes": "modes",
    "linearize_sampled": "sampled_linearization",
    "monodromy": "multirate",
    "plot_poles": "mode_plot",
    "run_study": "study",
    "z_width": "z_width_map",
}


def __getattr__(name: str) -> object:
    """Imports a public name from its module when it is first asked for."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    """Lists the public names, for completion."""
    return sorted(__all__)
