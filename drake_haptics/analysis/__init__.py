"""Analyzes how stable a diagram is: linear maps over a period, modes and bounds.

Works on any Drake diagram. The names are imported when they are first asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drake_haptics.analysis.axis_design import AxisDesign, GripMargins
    from drake_haptics.analysis.coupling_design import CouplingDesign, suggest_coupling
    from drake_haptics.analysis.delay_margin import calc_delay_margin
    from drake_haptics.analysis.equilibrium import Equilibrium, find_equilibrium
    from drake_haptics.analysis.exact_boundary import (
        BoundaryPoint,
        ExactBoundary,
        calc_boundary_peak,
        calc_exact_alpha,
        calc_exact_boundary,
    )
    from drake_haptics.analysis.felt_impedance import FeltImpedance, calc_felt_impedance
    from drake_haptics.analysis.held_loop import (
        CouplingGrowth,
        HeldLoop,
        analyse_held_scene,
    )
    from drake_haptics.analysis.held_scene import (
        HeldScene,
        find_firmest_contact,
        hold_scene,
    )
    from drake_haptics.analysis.jobs.pool import SerialExecutor
    from drake_haptics.analysis.jobs.progress import StudyProgress
    from drake_haptics.analysis.jobs.study import StudyError, run_study
    from drake_haptics.analysis.mode_plot import plot_poles
    from drake_haptics.analysis.modes import Mode, ModeKind, find_modes
    from drake_haptics.analysis.multirate import Monodromy, monodromy
    from drake_haptics.analysis.passivity import (
        Passivity,
        calc_passivity,
        make_spring_damper,
    )
    from drake_haptics.analysis.preconditions import explain_drake_errors
    from drake_haptics.analysis.sampled_linearization import (
        SampledLinearization,
        linearize_sampled,
    )
    from drake_haptics.analysis.sampled_wall import (
        SampledWall,
        calc_gain_margin,
        calc_largest_delay,
        calc_largest_stiffness,
    )
    from drake_haptics.analysis.scene_stability import SceneStability, analyse_scene
    from drake_haptics.analysis.stability_limit import (
        StabilityLimit,
        calc_growth,
        find_stability_limit,
        measure_growth,
    )
    from drake_haptics.analysis.stiffness_limits import (
        StiffnessLimits,
        find_stiffness_limits,
    )
    from drake_haptics.analysis.wall_bounds import (
        DelayBounds,
        QuantizationBounds,
        calc_delay_bounds,
        calc_quantization_bounds,
    )
    from drake_haptics.analysis.z_width_map import HeldBounds, ZWidth, z_width

__all__ = [
    "AxisDesign",
    "BoundaryPoint",
    "CouplingDesign",
    "CouplingGrowth",
    "DelayBounds",
    "Equilibrium",
    "ExactBoundary",
    "FeltImpedance",
    "GripMargins",
    "HeldBounds",
    "HeldLoop",
    "HeldScene",
    "Mode",
    "ModeKind",
    "Monodromy",
    "Passivity",
    "QuantizationBounds",
    "SampledLinearization",
    "SampledWall",
    "SceneStability",
    "SerialExecutor",
    "StabilityLimit",
    "StiffnessLimits",
    "StudyError",
    "StudyProgress",
    "ZWidth",
    "analyse_held_scene",
    "analyse_scene",
    "calc_boundary_peak",
    "calc_delay_bounds",
    "calc_delay_margin",
    "calc_exact_alpha",
    "calc_exact_boundary",
    "calc_felt_impedance",
    "calc_gain_margin",
    "calc_growth",
    "calc_largest_delay",
    "calc_largest_stiffness",
    "calc_passivity",
    "calc_quantization_bounds",
    "explain_drake_errors",
    "find_equilibrium",
    "find_firmest_contact",
    "find_modes",
    "find_stability_limit",
    "find_stiffness_limits",
    "hold_scene",
    "linearize_sampled",
    "make_spring_damper",
    "measure_growth",
    "monodromy",
    "plot_poles",
    "run_study",
    "suggest_coupling",
    "z_width",
]

_MODULE_OF = {
    "AxisDesign": "axis_design",
    "BoundaryPoint": "exact_boundary",
    "CouplingDesign": "coupling_design",
    "CouplingGrowth": "held_loop",
    "DelayBounds": "wall_bounds",
    "Equilibrium": "equilibrium",
    "ExactBoundary": "exact_boundary",
    "FeltImpedance": "felt_impedance",
    "GripMargins": "axis_design",
    "HeldBounds": "z_width_map",
    "HeldLoop": "held_loop",
    "HeldScene": "held_scene",
    "Mode": "modes",
    "ModeKind": "modes",
    "Monodromy": "multirate",
    "Passivity": "passivity",
    "QuantizationBounds": "wall_bounds",
    "SampledLinearization": "sampled_linearization",
    "SampledWall": "sampled_wall",
    "SceneStability": "scene_stability",
    "SerialExecutor": "jobs.pool",
    "StabilityLimit": "stability_limit",
    "StiffnessLimits": "stiffness_limits",
    "StudyError": "jobs.study",
    "StudyProgress": "jobs.progress",
    "ZWidth": "z_width_map",
    "analyse_held_scene": "held_loop",
    "analyse_scene": "scene_stability",
    "calc_boundary_peak": "exact_boundary",
    "calc_delay_bounds": "wall_bounds",
    "calc_delay_margin": "delay_margin",
    "calc_exact_alpha": "exact_boundary",
    "calc_exact_boundary": "exact_boundary",
    "calc_felt_impedance": "felt_impedance",
    "calc_gain_margin": "sampled_wall",
    "calc_growth": "stability_limit",
    "calc_largest_delay": "sampled_wall",
    "calc_largest_stiffness": "sampled_wall",
    "calc_passivity": "passivity",
    "calc_quantization_bounds": "wall_bounds",
    "explain_drake_errors": "preconditions",
    "find_equilibrium": "equilibrium",
    "find_firmest_contact": "held_scene",
    "find_modes": "modes",
    "find_stability_limit": "stability_limit",
    "find_stiffness_limits": "stiffness_limits",
    "hold_scene": "held_scene",
    "linearize_sampled": "sampled_linearization",
    "make_spring_damper": "passivity",
    "measure_growth": "stability_limit",
    "monodromy": "multirate",
    "plot_poles": "mode_plot",
    "run_study": "jobs.study",
    "suggest_coupling": "coupling_design",
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
