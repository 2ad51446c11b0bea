"""Designs a spring and damper for one kind of motion of a device."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from drake_haptics.analysis.exact_boundary import calc_boundary_peak
from drake_haptics.analysis.sampled_wall import (
    SampledWall,
    calc_gain_margin,
    calc_largest_delay,
    calc_largest_stiffness,
)
from drake_haptics.bounds.sampled_spring import (
    calc_passive_damping,
    calc_passive_stiffness,
    calc_stable_stiffness,
)
from drake_haptics.common.one_line import one_line
from drake_haptics.report.plain_data import to_plain_data

# Largest B T/m: the laws that the gains come from are of first order in it.
_LARGEST_BETA = 0.2


@dataclass(frozen=True)
class AxisDevice:
    """One kind of motion of a device, without a hand.

    Units are those of translation; for rotation kg·m², N·m·s/rad and N·m/rad.

    Attributes:
        mass: Least apparent mass in any direction, kg.
        damping: Least physical damping in any direction, N·s/m.
        rated_stiffness: Rated stiffness of the device, N/m; None if unknown.
        rated_damping: Rated damping of the device, N·s/m; None if unknown.
    """

    mass: float
    damping: float
    rated_stiffness: float | None = None
    rated_damping: float | None = None


@dataclass(frozen=True)
class GripMargins:
    """Margins of a coupling in one grip.

    Attributes:
        grip: Name of the grip.
        stiffness: Largest stable stiffness over the chosen one, with the chosen B.
        gain: The largest stable factor on both K and B.
        largest_delay_s: The longest stable delay, s, as from
            `calc_largest_delay`.
        held_damping: b of device and hand, N·s/m.
        is_passive: Whether b is enough for passivity.
    """

    grip: str
    stiffness: float
    gain: float
    largest_delay_s: float
    held_damping: float
    is_passive: bool


@dataclass(frozen=True)
class AxisDesign:
    """The gains for one kind of motion.

    Attributes:
        stiffness: K, N/m.
        damping: B, N·s/m.
        stiffness_limit: The bound that limits K, in words.
        damping_limit: The bound that limits B, in words.
        required_damping: Damping b that makes the coupling passive, N·s/m.
        device: The device that it is designed for.
        margins: Margins in each grip, the weakest first.
    """

    stiffness: float
    damping: float
    stiffness_limit: str
    damping_limit: str
    required_damping: float
    device: AxisDevice
    margins: tuple[GripMargins, ...]

    __repr__ = one_line

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields, ready for JSON."""
        return to_plain_data(self)


def design_axis(
    device: AxisDevice,
    grips: Mapping[str, SampledWall],
    margin: float,
    passive_in: str | None,
) -> AxisDesign:
    """Chooses K and B.

    B is the largest damping that every limit allows, and K then the largest stiffness:
    in every grip `margin` times K must be stable by the exact eigenvalues. `margin`
    times both gains is then stable too, since `margin` times B is still below the peak
    of the boundary.

    Args:
        device: The device without a hand.
        grips: The device in each hand that may hold it, by the name of the grip, with
            period and delay, against a wall without stiffness and damping.
        margin: Factor up to which the gains must be stable, above 1.
        passive_in: Name of a grip in which the coupling must also be passive; None for
            no such grip.

    Raises:
        ValueError: No stiffness has the margin.
    """
    some = next(iter(grips.values()))
    period_s, delay_s = some.period_s, some.delay_s
    dampings = {name: hand.damping + hand.hand_damping for name, hand in grips.items()}
    held = min(dampings.values())
    passive_damping = None if passive_in is None else dampings[passive_in]
    B, damping_limit = _least(
        _limit_damping(device, held, period_s, delay_s, margin, passive_damping)
    )
    walls = {name: replace(hand, wall_damping=B) for name, hand in grips.items()}
    K, stiffness_limit = _least(
        _limit_stiffness(device, held, walls, margin, passive_damping)
    )
    if not K > 0.0:
        raise ValueError(
            f"no stiffness is stable with a margin of {margin:g} at"
            f" {1.0 / period_s:g} Hz and a delay of {delay_s:g} s: limited by"
            f" {stiffness_limit}, with a damping of {B:g}, limited by {damping_limit}"
        )
    required = calc_passive_damping(K, B, period_s, delay_s)
    return AxisDesign(
        stiffness=K,
        damping=B,
        stiffness_limit=stiffness_limit,
        damping_limit=damping_limit,
        required_damping=required,
        device=device,
        margins=tuple(
            _calc_margins(name, walls[name], K, required)
            for name in sorted(walls, key=lambda name: grips[name].hand_damping)
        ),
    )


def _limit_damping(
    device: AxisDevice,
    held: float,
    period_s: float,
    delay_s: float,
    margin: float,
    passive_damping: float | None,
) -> dict[str, float]:
    """Returns the largest B that each limit allows, by the limit in words."""
    per_beta = device.mass / period_s
    # Damping above that of the stiffest wall costs stiffness.
    whole = math.ceil(delay_s / period_s - 1e-9)
    limits = {
        "the apparent mass of the device at this rate": _LARGEST_BETA * per_beta,
        "the delay": calc_boundary_peak(whole).beta / margin * per_beta,
    }
    if device.rated_damping is not None:
        limits["the rated damping of the device"] = device.rated_damping
    if passive_damping is not None:
        # Where the line of stability, over the margin, meets that of passivity:
        # (b + B)/margin = b_passive - B.
        limits["passivity in the hand"] = (margin * passive_damping - held) / (
            margin + 1.0
        )
    return limits


def _limit_stiffness(
    device: AxisDevice,
    held: float,
    walls: Mapping[str, SampledWall],
    margin: float,
    passive_damping: float | None,
) -> dict[str, float]:
    """Returns the largest K that each limit allows, by the limit in words."""
    some = next(iter(walls.values()))
    T, t_d, B = some.period_s, some.delay_s, some.wall_damping
    limits = {
        "the damping of device and coupling (law of Gil et al.)": (
            calc_stable_stiffness(held, B, T, t_d) / margin
        )
    }
    for name, wall in walls.items():
        limits[f"stability in the grip '{name}' (exact eigenvalues)"] = (
            calc_largest_stiffness(wall) / margin
        )
    if device.rated_stiffness is not None:
        limits["the rated stiffness of the device"] = device.rated_stiffness
    if passive_damping is not None:
        limits["passivity in the hand"] = calc_passive_stiffness(
            passive_damping, B, T, t_d
        )
    return limits


def _least(limits: Mapping[str, float]) -> tuple[float, str]:
    reason = min(limits, key=lambda name: limits[name])
    return limits[reason], reason


def _calc_margins(
    name: str, wall: SampledWall, stiffness: float, required: float
) -> GripMargins:
    chosen = replace(wall, stiffness=stiffness)
    held = wall.damping + wall.hand_damping
    return GripMargins(
        grip=name,
        stiffness=calc_largest_stiffness(chosen) / stiffness,
        gain=calc_gain_margin(chosen),
        largest_delay_s=calc_largest_delay(chosen),
        held_damping=held,
        # A design at the bound is passive, round-off or not.
        is_passive=required <= held * (1.0 + 1e-9),
    )
