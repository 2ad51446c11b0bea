"""Picture of what is stable and what is passive, over a coupling's gains."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from drake_haptics.analysis.axis_design import AxisDesign, AxisHand, make_wall
from drake_haptics.analysis.sampled_wall import calc_largest_stiffness
from drake_haptics.bounds.sampled_spring import (
    calc_passive_stiffness,
    calc_stable_stiffness,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 40
# The picture reaches this many times the suggested stiffness at most.
_HEADROOM = 12.0


def plot_axis_design(
    axes: Axes,
    design: AxisDesign,
    period_s: float,
    delay_s: float,
    units: tuple[str, str],
) -> None:
    """Draws K over B: the device's limits when let go, passivity, and the choice.

    Args:
        axes: Where.
        design: Of one kind of motion.
        period_s: T, s.
        delay_s: t_d, s.
        units: Of K and of B.
    """
    device = design.device
    B = np.linspace(0.0, 3.0 * design.damping, _POINTS)
    free = make_wall(device, AxisHand(), period_s, delay_s)
    stable = [calc_largest_stiffness(replace(free, wall_damping=b)) for b in B]
    axes.fill_between(B, stable, color="C0", alpha=0.15)
    axes.plot(B, stable, color="C0", label="stable, let go (exact)")
    law = [calc_stable_stiffness(device.damping, b, period_s, delay_s) for b in B]
    axes.plot(B, law, "--", color="C0", lw=1.0, label="law of Gil et al.")
    passive = [
        (m, calc_passive_stiffness(m.held_damping, 0.0, period_s, delay_s))
        for m in design.margins
    ]
    top = min(1.1 * max(stable), _HEADROOM * design.stiffness)
    # Those that would be out of sight stay out of the legend.
    visible = [
        (margins, K)
        for margins, K in passive
        if margins.held_damping > 0.02 * B[-1]
        and B[-1] / margins.held_damping + top / K > 1.0
    ]
    for i, (margins, K) in enumerate(visible, start=1):
        axes.plot(
            [0.0, margins.held_damping],
            [K, 0.0],
            ":",
            color=f"C{i + (i > 2)}",
            label=f"passive below, grip '{margins.grip}'",
        )
    if device.rated_stiffness is not None:
        axes.axhline(device.rated_stiffness, color="0.7", lw=0.8, label="rated")
    if device.rated_damping is not None:
        axes.axvline(device.rated_damping, color="0.7", lw=0.8)
    axes.plot(design.damping, design.stiffness, "o", color="C3", label="suggested")
    axes.set_xlim(0.0, B[-1])
    axes.set_ylim(0.0, top)
    axes.set_xlabel(f"damping, {units[1]}")
    axes.set_ylabel(f"stiffness, {units[0]}")
    axes.legend(
        fontsize="small", ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.15)
    )
