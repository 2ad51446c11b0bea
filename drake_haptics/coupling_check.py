"""Checks whether a coupling is passive and stable on a device in a hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from drake_haptics.passivity_bounds import (
    calc_passive_damping,
    calc_sampled_damping,
    calc_stable_stiffness,
)


class SpringAndDamper(Protocol):
    """Six-axis gains, as `CouplingGains` and a scene's `Coupling` have them."""

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
    """What device and hand are at the handle, together.

    Attributes:
        mass_kg: The least in any direction, kg.
        damping_Ns_per_m: Physical damping, N·s/m.
        inertia_kgm2: The least about any axis, kg·m².
        rotational_damping_Nms_per_rad: N·m·s/rad.
        stiffness_N_per_m: Of the hand's spring, N/m.
        rotational_stiffness_Nm_per_rad: N·m/rad.
    """

    mass_kg: float
    damping_Ns_per_m: float
    inertia_kgm2: float
    rotational_damping_Nms_per_rad: float
    stiffness_N_per_m: float = 0.0
    rotational_stiffness_Nm_per_rad: float = 0.0


@dataclass(frozen=True)
class _Kind:
    """Names and units of translation or of rotation."""

    stiffness: str
    stiffness_unit: str
    damping: str
    damping_unit: str
    mass_unit: str


_TRANSLATION = _Kind("stiffness_N_per_m", "N/m", "damping_Ns_per_m", "N·s/m", "kg")
_ROTATION = _Kind(
    "rotational_stiffness_Nm_per_rad",
    "N·m/rad",
    "rotational_damping_Nms_per_rad",
    "N·m·s/rad",
    "kg·m²",
)


def check_coupling(
    coupling: SpringAndDamper,
    handle: HeldHandle,
    period_s: float,
    delay_s: float = 0.0,
) -> list[str]:
    """Checks a coupling against the bounds of `drake_haptics.passivity_bounds`.

    Args:
        coupling: K and B of both kinds.
        handle: What they act on.
        period_s: The tick T, s.
        delay_s: Delay t_d on top of the hold's half period, s.

    Returns:
        A sentence for each bound that is broken: which value, which bound, what to
        change. Empty if the loop is stable by `calc_stable_stiffness` and
        `calc_sampled_damping`, and passive by `calc_passive_damping`, in which the
        damping of the hand counts.

    Raises:
        ValueError: The period, the mass or the inertia is not positive.
    """
    for name, value in [
        ("period_s", period_s),
        ("mass_kg", handle.mass_kg),
        ("inertia_kgm2", handle.inertia_kgm2),
    ]:
        if not value > 0.0:
            raise ValueError(f"{name} must be positive, is {value}")
    found = []
    for kind, m, b in [
        (_TRANSLATION, handle.mass_kg, handle.damping_Ns_per_m),
        (_ROTATION, handle.inertia_kgm2, handle.rotational_damping_Nms_per_rad),
    ]:
        K, B = getattr(coupling, kind.stiffness), getattr(coupling, kind.damping)
        found += [
            *_check_stiffness(kind, K, B, b, period_s, delay_s),
            *_check_damping(kind, K, B, m, period_s),
            *_check_passivity(kind, K, B, b, period_s, delay_s),
        ]
    return found


def _check_stiffness(
    kind: _Kind, K: float, B: float, b: float, period_s: float, delay_s: float
) -> list[str]:
    """Checks K against the law of Gil et al."""
    bound = calc_stable_stiffness(b, B, period_s, delay_s)
    if K <= bound:
        return []
    return [
        f"{kind.stiffness} is {K:g}, but stable only up to {bound:.5g}"
        f" {kind.stiffness_unit}, (b + B) / (T/2 + t_d) (Gil et al.), with b = {b:g}"
        f" {kind.damping_unit} of device and hand at {1.0 / period_s:g} Hz: lower it,"
        f" raise {kind.damping} or the rate, or hold the device more firmly"
    ]


def _check_damping(
    kind: _Kind, K: float, B: float, m: float, period_s: float
) -> list[str]:
    """Checks B against Jury's criterion."""
    bound = calc_sampled_damping(m, K, period_s)
    if B <= bound:
        return []
    if bound == 0.0:
        return [
            f"{kind.stiffness} is {K:g}, too stiff for any damping (Jury's criterion)"
            f" on {m:.3g} {kind.mass_unit} of device and hand at {1.0 / period_s:g} Hz:"
            " lower it or raise the rate"
        ]
    return [
        f"{kind.damping} is {B:g}, but stable only up to {bound:.5g}"
        f" {kind.damping_unit}, below 2 m/T (Jury's criterion), on {m:.3g}"
        f" {kind.mass_unit} of device and hand at {1.0 / period_s:g} Hz: lower it or"
        " raise the rate"
    ]


def _check_passivity(
    kind: _Kind, K: float, B: float, b: float, period_s: float, delay_s: float
) -> list[str]:
    """Checks K and B against the bound of Colgate and Schenkel."""
    bound = calc_passive_damping(K, B, period_s, delay_s)
    if b >= bound:
        return []
    name, value = (kind.damping, B) if 2.0 * B > K * period_s else (kind.stiffness, K)
    return [
        f"{name} is {value:g}: not passive, because device and hand damp"
        f" by b = {b:g} {kind.damping_unit} and K (T/2 + t_d) + |B| is {bound:.5g}"
        " (Colgate and Schenkel), so that some grips may vibrate: lower"
        f" {kind.damping} or {kind.stiffness}, raise the rate, or hold the device more"
        " firmly"
    ]
