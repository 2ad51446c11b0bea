"""Finds the largest stable stiffness of a scene's coupling, in four ways."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, get_args

from scipy.optimize import brentq

from drake_haptics.analysis.held_loop import (
    HeldLoop,
    analyze_held_scene,
    build_with_same_load,
)
from drake_haptics.analysis.held_scene import HeldScene
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.modes import describe_motion, find_modes
from drake_haptics.analysis.sampled_wall import SampledWall, calc_largest_stiffness
from drake_haptics.analysis.stability_limit import find_stability_limit
from drake_haptics.bounds.coupling import ROTATION, TRANSLATION
from drake_haptics.bounds.held_handle import calc_force_delay, calc_scene_handle
from drake_haptics.bounds.sampled_spring import calc_stable_stiffness
from drake_haptics.report.plain_data import to_plain_data

Kind = Literal["translation", "rotation"]
Against = Literal["this contact", "a rigid wall"]

_KINDS = {"translation": TRANSLATION, "rotation": ROTATION}
# Stiffnesses are tried within this factor of the scene's.
_RANGE = 1e4
# Simulations are compared with eigenvalues within this share of the limit.
_NEAR = 0.1


@dataclass(frozen=True)
class StiffnessLimits:
    """The largest stable stiffness of a coupling, its other gains as in the scene.

    Stiffnesses are in N/m for translation and N·m/rad for rotation.

    Attributes:
        kind: Kind of the stiffness.
        against: Contact in which the tool is held, or a rigid wall, the worst case for
            stability (`HeldScene.against_rigid_wall`).
        stiffness: Stiffness in the scene.
        damping: Damping in the scene, N·s/m or N·m·s/rad.
        eigenvalue: Stiffness at which an eigenvalue of one tick reaches magnitude 1;
            infinite if none does up to 10⁴ times the scene's; 0 if even 10⁻⁴ of the
            scene's is unstable.
        simulated: Stiffness at which a small disturbance no longer dies out in
            simulation; NaN if there is nothing to compare.
        one_axis: The exact limit of one axis with the least inertia and damping that
            device and hand have in any direction where they hold the tool, against a
            rigid wall (`SampledWall`).
        formula: (b + B) / (T/2 + t_d) of the same axis (Gil et al. 2004).
        limited_by: Frequency and moving parts of the motion that grows beyond the
            limit; of the scene's if that is 0, because another gain is too large.
    """

    kind: Kind
    against: Against
    stiffness: float
    damping: float
    eigenvalue: float
    simulated: float
    one_axis: float
    formula: float
    limited_by: str

    @property
    def unit(self) -> str:
        """Unit of all stiffnesses."""
        return _KINDS[self.kind].stiffness_unit

    @property
    def gain_margin(self) -> float:
        """The largest stable stiffness over the scene's."""
        return self.eigenvalue / self.stiffness

    def format_values(self) -> list[str]:
        """Returns the stiffness in the scene and the limits, found in four ways.

        One axis and the formula are of a rigid wall, and are left out beside another
        contact.
        """
        limits = [self.eigenvalue, self.simulated, self.one_axis, self.formula]
        words = [format_limit(value) for value in (self.stiffness, *limits)]
        return words if self.against == "a rigid wall" else [*words[:3], "–", "–"]

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields and the margin, with None for infinities and NaN."""
        return to_plain_data(
            asdict(self) | {"unit": self.unit, "gain_margin": self.gain_margin}
        )


@on_one_blas_thread
def find_stiffness_limits(
    held: HeldScene,
    kind: Kind,
    against: Against = "this contact",
    progress: Callable[[float], None] | None = None,
) -> StiffnessLimits:
    """Finds the largest stable stiffness of a held scene's coupling in four ways.

    Args:
        held: The held scene, whose other gains stay.
        kind: Kind of the stiffness that is raised.
        against: Name of the body that the tool touches.
        progress: Function that is called with the share done, from 0 to 1.

    Raises:
        ValueError: There is no such kind or body, or the scene's coupling has no
            stiffness of that kind.
    """
    for name, word, known in [
        ("kind", kind, get_args(Kind)),
        ("against", against, get_args(Against)),
    ]:
        if word not in known:
            raise ValueError(
                f"{name} must be {' or '.join(map(repr, known))}, is {word!r}"
            )
    report = progress or (lambda share: None)
    names = _KINDS[kind]
    stiffness = getattr(held.scene.coupling, names.stiffness)
    damping = getattr(held.scene.coupling, names.damping)
    if not stiffness > 0.0:
        raise ValueError(f"coupling.{names.stiffness} must be above 0, is {stiffness}")
    if against == "a rigid wall":
        held = held.against_rigid_wall()
    done = 0

    def analyze(value: float) -> HeldLoop:
        nonlocal done
        done += 1
        report(1.0 - 0.9**done)
        coupling = replace(held.scene.coupling, **{names.stiffness: value})
        return analyze_held_scene(held, coupling)

    reasons: dict[float, str] = {}

    def growth(value: float) -> float:
        try:
            return analyze(value).growth
        except ValueError as error:
            reasons[value] = str(error)
            return math.nan

    found = find_stability_limit(
        growth, stiffness, lowest=stiffness / _RANGE, highest=stiffness * _RANGE
    )
    limit = found.value
    simulated, words = math.nan, "nothing in the range that was searched"
    if found.is_crossing:
        simulated = _find_simulated(
            lambda value: analyze(value).measure_growth(), limit
        )
        words = describe_motion(find_modes(analyze(limit).linearization)[0])
    elif limit == 0.0 and not math.isnan(growth(stiffness)):
        words = describe_motion(find_modes(analyze(stiffness).linearization)[0])
    elif reasons:
        words = f"beyond it nothing can be told: {reasons[min(reasons)]}"
    haptic, context = build_with_same_load(held)
    handle = calc_scene_handle(held.scene, haptic.loop.device, context)
    wall = SampledWall(
        mass=getattr(handle, names.mass),
        damping=getattr(handle, names.damping),
        period_s=1.0 / held.scene.device.rate_hz,
        wall_damping=damping,
        delay_s=calc_force_delay(held.scene),
        hand_stiffness=getattr(handle, names.stiffness),
        true_velocity=True,
    )
    report(1.0)
    return StiffnessLimits(
        kind=kind,
        against=against,
        stiffness=stiffness,
        damping=damping,
        eigenvalue=limit,
        simulated=simulated,
        one_axis=calc_largest_stiffness(wall),
        formula=calc_stable_stiffness(
            wall.damping, damping, wall.period_s, wall.delay_s
        ),
        limited_by=words,
    )


def _find_simulated(growth: Callable[[float], float], near: float) -> float:
    """Returns where simulated growth passes 1 near a value, or NaN."""

    def excess(logarithm: float) -> float:
        return growth(math.exp(logarithm)) - 1.0

    low, high = math.log(near * (1.0 - _NEAR)), math.log(near * (1.0 + _NEAR))
    try:
        return math.exp(brentq(excess, low, high, xtol=1e-4))
    except ValueError:  # No change of sign, or nothing to measure.
        return math.nan


def format_limit(value: float) -> str:
    """Returns a limit with five digits, or in words without a limit."""
    if math.isnan(value):
        return "not seen"
    if math.isinf(value):
        return "none found"
    # Seven, so that no limit of interest is written with an exponent.
    return f"{float(f'{value:.5g}'):,.7g}" if value > 0.0 else "none is stable"
