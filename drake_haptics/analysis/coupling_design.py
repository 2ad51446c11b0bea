"""Designs the gains of a virtual coupling for a device, a rate and a delay."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from pydrake.math import RigidTransform

from drake_haptics.analysis.axis_design import AxisDesign, AxisDevice, design_axis
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.sampled_wall import SampledWall, calc_largest_stiffness
from drake_haptics.bounds.coupling import ROTATION, TRANSLATION, HeldHandle, MotionKind
from drake_haptics.bounds.held_handle import calc_held_handle
from drake_haptics.bounds.sampled_spring import (
    calc_passive_stiffness,
    calc_stable_stiffness,
)
from drake_haptics.common.colors import EIGENVALUE, FORMULA, INKS
from drake_haptics.common.one_line import one_line
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.common.value_checks import check_at_least, check_positive
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.scene.device_preset import DevicePreset, load_device_preset
from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.simulated_arm import make_arm_plant

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_POINTS = 40
# Largest stiffness in the plot, over the suggested one.
_HEADROOM = 12.0


def plot_axis_design(
    axes: Axes,
    design: AxisDesign,
    period_s: float,
    delay_s: float,
    kind: MotionKind,
) -> None:
    """Draws K over B: stability without a hand, passivity, and the chosen gains."""
    device = design.device
    B = np.linspace(0.0, 3.0 * design.damping, _POINTS)
    free = SampledWall(device.mass, device.damping, period_s, delay_s=delay_s)
    stable = [calc_largest_stiffness(replace(free, wall_damping=b)) for b in B]
    axes.fill_between(B, stable, color=EIGENVALUE, alpha=0.15)
    axes.plot(B, stable, color=EIGENVALUE, label="stable, let go (exact)")
    law = [calc_stable_stiffness(device.damping, b, period_s, delay_s) for b in B]
    axes.plot(B, law, "--", color=FORMULA, lw=1.0, label="law of Gil et al.")
    passive = [
        (m, calc_passive_stiffness(m.held_damping, 0.0, period_s, delay_s))
        for m in design.margins
    ]
    top = min(1.1 * max(stable), _HEADROOM * design.stiffness)
    # Lines outside the axes must not be in the legend.
    visible = [
        (margins, K)
        for margins, K in passive
        if margins.held_damping > 0.02 * B[-1]
        and B[-1] / margins.held_damping + top / K > 1.0
    ]
    for i, (margins, K) in enumerate(visible):
        axes.plot(
            [0.0, margins.held_damping],
            [K, 0.0],
            ":",
            color=INKS[i % len(INKS)],
            label=f"passive below, grip '{margins.grip}'",
        )
    if device.rated_stiffness is not None:
        axes.axhline(device.rated_stiffness, color="0.7", lw=0.8, label="rated")
    if device.rated_damping is not None:
        axes.axvline(device.rated_damping, color="0.7", lw=0.8)
    axes.plot(
        design.damping, design.stiffness, "*", ms=12, color="black", label="suggested"
    )
    axes.set_xlim(0.0, B[-1])
    axes.set_ylim(0.0, top)
    axes.set_xlabel(f"damping, {kind.damping_unit}")
    axes.set_ylabel(f"stiffness, {kind.stiffness_unit}")
    axes.legend(
        fontsize="small", ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.15)
    )


@dataclass(frozen=True)
class CouplingDesign:
    """The gains of a coupling, and their margins.

    Attributes:
        coupling: The gains, as a scene has them.
        period_s: T, s.
        delay_s: t_d on top of the hold's half period, s.
        margin: Factor up to which the gains are stable.
        translation: Design in N/m and N·s/m.
        rotation: Design in N·m/rad and N·m·s/rad; None for a device without torque.
    """

    coupling: CouplingParameters
    period_s: float
    delay_s: float
    margin: float
    translation: AxisDesign
    rotation: AxisDesign | None

    __repr__ = one_line

    def describe(self) -> str:
        """Returns lines of text with the gains and what limits them."""
        lines = [f"At {1.0 / self.period_s:g} Hz and {1e3 * self.delay_s:g} ms delay:"]
        for kind, axis in self._list_kinds():
            name = "rotational " if kind is ROTATION else ""
            passive = [m.grip for m in axis.margins if m.is_passive]
            weakest = min(axis.margins, key=lambda m: min(m.stiffness, m.gain))
            lines += [
                f"{name}stiffness {axis.stiffness:.4g} {kind.stiffness_unit},"
                f" limited by {axis.stiffness_limit}",
                f"{name}damping {axis.damping:.4g} {kind.damping_unit},"
                f" limited by {axis.damping_limit}",
                f"  stable with {min(weakest.stiffness, weakest.gain):.3g} times that,"
                f" the least in the grip '{weakest.grip}'",
                f"  passive with {axis.required_damping:.4g} {kind.damping_unit} of"
                f" device and hand: {', '.join(passive) if passive else 'in no grip'}",
            ]
        return "\n".join(lines)

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the stable and the passive region over B and K, and the chosen gains.

        Args:
            axes: Axes for the translation. Defaults to new ones, next to those of the
                rotation.

        Returns:
            The axes of the translation.
        """
        kinds = self._list_kinds()
        if axes is not None:
            kinds, panels = kinds[:1], [axes]
        else:
            from matplotlib import pyplot

            size_inch = (10.0 if len(kinds) > 1 else 5.5, 5.0)
            _, row = pyplot.subplots(
                1, len(kinds), figsize=size_inch, layout="tight", squeeze=False
            )
            panels = list(row[0])
        for panel, (kind, design) in zip(panels, kinds, strict=True):
            plot_axis_design(panel, design, self.period_s, self.delay_s, kind)
            panel.set_title("rotation" if kind is ROTATION else "translation")
        return panels[0]

    def _list_kinds(self) -> list[tuple[MotionKind, AxisDesign]]:
        """Returns the kinds of motion, each with its design."""
        if self.rotation is None:
            return [(TRANSLATION, self.translation)]
        return [(TRANSLATION, self.translation), (ROTATION, self.rotation)]

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON."""
        return to_plain_data(self)


@on_one_blas_thread
def suggest_coupling(
    device: str | DevicePreset | HeldHandle,
    rate_hz: float,
    *,
    hand: str | None = None,
    delay_s: float = 0.0,
    margin: float = 2.0,
) -> CouplingDesign:
    """Suggests the gains of a coupling.

    The damping B is at most what the device is rated for, and B T/m at most 0.2; the
    stiffness is (b + B)/(T/2 + t_d) over the margin, with the damping b of the device
    alone, at most what it is rated for, and lowered until the exact eigenvalues have
    the margin in every grip of `HAND_GRIPS`, including "none", because a handle may be
    let go. The tool is assumed to be held still by a rigid wall, which makes the
    coupling stiffest.

    Args:
        device: Name of a preset, or a preset, whose arm is taken at its default angles;
            or a handle without a hand, which has no ratings, as `calc_held_handle`
            returns for any plant.
        rate_hz: Rate of the haptic loop, Hz.
        hand: Name of a grip of `HAND_GRIPS` in which the coupling must also be passive,
            which lowers B. Defaults to no such grip; the design then only reports in
            which grips the coupling is passive.
        delay_s: t_d on top of the hold's half period, s.
        margin: Factor up to which the gains must be stable, above 1.

    Raises:
        SceneError: There is no such preset.
        ValueError: There is no such grip, the rate, mass or inertia is not positive,
            the delay or a damping is negative, the delay is above 1,000 periods, the
            margin is not above 1, or no stiffness has it.
        TypeError: The device is of another type.
    """
    check_positive(rate_hz=rate_hz)
    check_at_least(0, delay_s=delay_s)
    if not (margin > 1.0 and np.isfinite(margin)):
        raise ValueError(f"margin must be above 1, is {margin}")
    if hand is not None and hand not in HAND_GRIPS:
        raise ValueError(f"hand: '{hand}' is not one of {', '.join(HAND_GRIPS)}")
    handle, preset = _read_device(device)
    period_s = 1.0 / rate_hz

    def design(kind: MotionKind) -> AxisDesign:
        axis = AxisDevice(
            getattr(handle, kind.mass),
            getattr(handle, kind.damping),
            # A handle of your own has no ratings.
            getattr(preset, f"max_{kind.stiffness}", None),
            getattr(preset, f"max_{kind.damping}", None),
        )
        free = SampledWall(axis.mass, axis.damping, period_s, delay_s=delay_s)
        grips = {
            name: free
            if grip is None
            else replace(
                free,
                hand_mass=getattr(grip, kind.mass),
                hand_damping=getattr(grip, kind.damping),
                hand_stiffness=getattr(grip, kind.stiffness),
            )
            for name, grip in HAND_GRIPS.items()
        }
        return design_axis(axis, grips, margin, hand)

    translation, rotation = design(TRANSLATION), None
    if preset is None or preset.max_torque_Nm > 0.0:
        rotation = design(ROTATION)
    return CouplingDesign(
        coupling=CouplingParameters(
            translation.stiffness,
            translation.damping,
            rotation.stiffness if rotation else 0.0,
            rotation.damping if rotation else 0.0,
        ),
        period_s=period_s,
        delay_s=delay_s,
        margin=margin,
        translation=translation,
        rotation=rotation,
    )


def _read_device(
    device: str | DevicePreset | HeldHandle,
) -> tuple[HeldHandle, DevicePreset | None]:
    """Returns the handle without a hand, and its ratings if there are any."""
    require_kinds(device=(device, str | DevicePreset | HeldHandle))
    if isinstance(device, HeldHandle):
        return device, None
    preset = load_device_preset(device) if isinstance(device, str) else device
    plant = make_arm_plant(preset.model_path, RigidTransform())
    plant.Finalize()
    handle = plant.GetBodyByName(preset.handle_link)
    return calc_held_handle(plant, handle, None), preset
