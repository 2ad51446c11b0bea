"""Checks whether a coupling is stable, passive and within a device's ratings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from drake_haptics.bounds.sampled_spring import (
    calc_passive_damping,
    calc_sampled_damping,
    calc_stable_stiffness,
)
from drake_haptics.common.value_checks import check_positive
from drake_haptics.scene.device_preset import DevicePreset


class SpringAndDamper(Protocol):
    """Six-axis gains, such as `CouplingGains` and `CouplingParameters`."""

    @property
    def stiffness_N_per_m(self) -> float: ...  # noqa: D102

    @property
    def damping_Ns_per_m(self) -> float: ...  # noqa: D102

    @property
    def rotational_stiffness_Nm_per_rad(self) -> float: ...  # noqa: D102

    @property
    def rotational_damping_Nms_per_rad(self) -> float: ...  # noqa: D102


@dataclass(frozen=True)
class HeldHandle:
    """Mass, damping and stiffness of device and hand together, at the handle.

    Attributes:
        mass_kg: Least mass in any direction, kg.
        damping_Ns_per_m: Physical damping, N·s/m.
        inertia_kgm2: Least inertia about any axis, kg·m².
        rotational_damping_Nms_per_rad: Physical damping of rotation, N·m·s/rad.
        stiffness_N_per_m: Stiffness of the hand's spring, N/m.
        rotational_stiffness_Nm_per_rad: Stiffness of the hand's spring in rotation,
            N·m/rad.
    """

    mass_kg: float
    damping_Ns_per_m: float
    inertia_kgm2: float
    rotational_damping_Nms_per_rad: float
    stiffness_N_per_m: float = 0.0
    rotational_stiffness_Nm_per_rad: float = 0.0


@dataclass(frozen=True)
class BrokenBound:
    """A bound that a coupling breaks.

    Attributes:
        key: Name of the value to be changed, an attribute of `SpringAndDamper`.
        words: Consequence and remedy, without symbols.
        sentence: Sentence with the value, the bound and its law, and the remedy.
    """

    key: str
    words: str
    sentence: str


@dataclass(frozen=True)
class MotionKind:
    """Names and units of the values of translation or of rotation.

    Attributes:
        stiffness: Name of the stiffness of a coupling, a hand or a held handle.
        stiffness_unit: Its unit.
        damping: Name of the damping, likewise.
        damping_unit: Its unit.
        mass: Name of the mass or inertia of a hand or a held handle.
        mass_unit: Its unit.
    """

    stiffness: str
    stiffness_unit: str
    damping: str
    damping_unit: str
    mass: str
    mass_unit: str


TRANSLATION = MotionKind(
    stiffness="stiffness_N_per_m",
    stiffness_unit="N/m",
    damping="damping_Ns_per_m",
    damping_unit="N·s/m",
    mass="mass_kg",
    mass_unit="kg",
)
ROTATION = MotionKind(
    stiffness="rotational_stiffness_Nm_per_rad",
    stiffness_unit="N·m/rad",
    damping="rotational_damping_Nms_per_rad",
    damping_unit="N·m·s/rad",
    mass="inertia_kgm2",
    mass_unit="kg·m²",
)


def find_broken_bounds(
    coupling: SpringAndDamper, handle: HeldHandle, period_s: float, delay_s: float = 0.0
) -> list[BrokenBound]:
    """Checks a coupling against the bounds of `drake_haptics.bounds.sampled_spring`.

    Returns:
        The broken bounds; empty if the loop is stable by `calc_stable_stiffness` and
        `calc_sampled_damping`, and passive by `calc_passive_damping` with the damping
        of the hand.

    Raises:
        ValueError: The period, the mass or the inertia is not positive.
    """
    check_positive(
        period_s=period_s, mass_kg=handle.mass_kg, inertia_kgm2=handle.inertia_kgm2
    )
    found: list[BrokenBound] = []
    for kind in (TRANSLATION, ROTATION):
        K, B = getattr(coupling, kind.stiffness), getattr(coupling, kind.damping)
        m, b = getattr(handle, kind.mass), getattr(handle, kind.damping)
        checked = (
            _check_stiffness(kind, K, B, b, period_s, delay_s),
            _check_damping(kind, K, B, m, period_s),
            _check_passivity(kind, K, B, b, period_s, delay_s),
        )
        found += [bound for bound in checked if bound is not None]
    return found


def find_exceeded_ratings(
    coupling: SpringAndDamper, preset: DevicePreset
) -> list[BrokenBound]:
    """Compares a coupling with the ratings of its device.

    Args:
        coupling: K and B of both kinds.
        preset: The device; ratings that are unknown are skipped.
    """
    found: list[BrokenBound] = []
    for kind in (TRANSLATION, ROTATION):
        for key, unit in (
            (kind.stiffness, kind.stiffness_unit),
            (kind.damping, kind.damping_unit),
        ):
            value, rating = getattr(coupling, key), getattr(preset, f"max_{key}")
            if rating is not None and value > rating:
                found.append(
                    BrokenBound(
                        key,
                        f"This may shake: the device is rated for {rating:.3g} {unit}."
                        " Lower it.",
                        f"{key} is {value:g}, but the device, {preset.description}, is"
                        f" rated for {rating:g} {unit}: lower it",
                    )
                )
    return found


def _check_stiffness(
    kind: MotionKind, K: float, B: float, b: float, period_s: float, delay_s: float
) -> BrokenBound | None:
    """Checks K against the law of Gil et al."""
    bound = calc_stable_stiffness(b, B, period_s, delay_s)
    if K <= bound:
        return None
    return BrokenBound(
        kind.stiffness,
        f"This will shake: device and hand bear {bound:.3g} {kind.stiffness_unit}"
        " at this rate. Lower it, raise the damping, or hold more firmly.",
        f"{kind.stiffness} is {K:g}, but stable only up to {bound:.5g}"
        f" {kind.stiffness_unit}, (b + B) / (T/2 + t_d) (Gil et al.), with"
        f" b = {b:.3g} {kind.damping_unit} of device and hand at"
        f" {1.0 / period_s:g} Hz: lower it, raise {kind.damping} or the rate, or"
        " hold the device more firmly",
    )


def _check_damping(
    kind: MotionKind, K: float, B: float, m: float, period_s: float
) -> BrokenBound | None:
    bound = calc_sampled_damping(m, K, period_s)
    if B <= bound:
        return None
    if bound == 0.0:
        return BrokenBound(
            kind.stiffness,
            f"This will shake, whatever the damping: device and hand have {m:.2g}"
            f" {kind.mass_unit}, too little at this rate. Lower it.",
            f"{kind.stiffness} is {K:g}, too stiff for any damping (Jury's"
            f" criterion) on {m:.3g} {kind.mass_unit} of device and hand at"
            f" {1.0 / period_s:g} Hz: lower it or raise the rate",
        )
    return BrokenBound(
        kind.damping,
        f"This will shake: device and hand bear {bound:.3g} {kind.damping_unit} at"
        " this rate. Lower it.",
        f"{kind.damping} is {B:g}, but stable only up to {bound:.5g}"
        f" {kind.damping_unit}, below 2 m/T (Jury's criterion), on {m:.3g}"
        f" {kind.mass_unit} of device and hand at {1.0 / period_s:g} Hz: lower it"
        " or raise the rate",
    )


def _check_passivity(
    kind: MotionKind, K: float, B: float, b: float, period_s: float, delay_s: float
) -> BrokenBound | None:
    """Checks K and B against the bound of Colgate and Schenkel."""
    bound = calc_passive_damping(K, B, period_s, delay_s)
    if b >= bound:
        return None
    name, value = (kind.damping, B) if 2.0 * B > K * period_s else (kind.stiffness, K)
    return BrokenBound(
        name,
        f"A loose grip may vibrate: device and hand damp by {b:.3g}"
        f" {kind.damping_unit}, stiffness and damping together ask for"
        f" {bound:.3g}. Lower one of them, or hold more firmly.",
        f"{name} is {value:g}: not passive, because device and hand damp"
        f" by b = {b:.3g} {kind.damping_unit} and K (T/2 + t_d) + |B| is"
        f" {bound:.5g} (Colgate and Schenkel), so that some grips may vibrate:"
        f" lower {kind.damping} or {kind.stiffness}, raise the rate, or hold the"
        " device more firmly",
    )
