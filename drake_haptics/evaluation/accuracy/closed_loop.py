"""Measures the energy that a setting's loop creates, and its stable stiffness."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.held_scene import HeldScene, hold_scene
from drake_haptics.analysis.stability_limit import find_stability_limit
from drake_haptics.evaluation.accuracy.costs import cached_build
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import RunError, run

# Account of the whole loop; all other accounts are its parts.
_WHOLE = "device"
# The linearization's message would be about systems.
_TWO_RATES = "the query has another rate than the loop, and a linear map has one rate"
# Stiffnesses are searched within this factor of the scene's, to this relative error.
_RANGE = 1e4
_TOLERANCE = 1e-2


@dataclass(frozen=True)
class PressedPlace:
    """The time on its path at which a scene's hand stops.

    The scene's largest stable stiffness there is near those of other settings.
    """

    time_s: float
    near_N_per_m: float


def measure_created_energy(scene: Scene, duration_s: float) -> float:
    """Returns the energy that a scene's loop creates, J; infinite if it diverges.

    It is the sum of the energies that the parts of the loop have created, from an
    `EnergyLedger`. Energy that the sampling of forces explains is included, because a
    slower rate creates more of it; the account of the whole loop is not, because in it
    dampers hide what another part creates.
    """
    try:
        statistics = run(cached_build(scene), duration_s, energy=True)
    except RunError:
        return math.inf
    books = statistics.to_dict()["energy_J"]
    assert isinstance(books, dict)
    return float(
        sum(account["created"] for name, account in books.items() if name != _WHOLE)
    )


def find_pressed_place(scene: Scene) -> PressedPlace | str:
    """Returns where a scene's tool is pressed hardest and rests, or why nowhere."""
    try:
        held = hold_scene(scene)
        limit = _find_limit(scene, held, scene.coupling.stiffness_N_per_m)
    except (ValueError, RunError) as error:
        return str(error)
    return PressedPlace(held.time_s, limit)


def find_stable_stiffness(
    scene: Scene, place: PressedPlace | str
) -> tuple[float | None, str]:
    """Finds the largest stable stiffness of a coupling with its tool held in contact.

    It is the translational one at which an eigenvalue of one tick reaches magnitude 1.

    Args:
        scene: The scene with the coupling.
        place: Place where the tool is held, or the reason why there is no place.

    Returns:
        The stiffness, N/m, infinite if there is no limit; None if it is unknown, and
        the reason, which is empty otherwise.
    """
    if isinstance(place, str):
        return None, place
    if scene.contact.query_rate_hz is not None:
        return None, _TWO_RATES
    try:
        held = hold_scene(scene, place.time_s)
        return _find_limit(scene, held, place.near_N_per_m), ""
    except (ValueError, RunError) as error:
        return None, str(error)


def _find_limit(scene: Scene, held: HeldScene, near_N_per_m: float) -> float:
    """Returns the largest stable stiffness, N/m, searched from one near it.

    Raises:
        ValueError: No stiffness was found stable, and some could not be analyzed.
    """
    stiffness = scene.coupling.stiffness_N_per_m
    lowest, highest = stiffness / _RANGE, stiffness * _RANGE
    reasons: list[str] = []

    def growth(value: float) -> float:
        coupling = replace(scene.coupling, stiffness_N_per_m=value)
        try:
            return analyze_held_scene(held, coupling).growth
        except ValueError as error:
            # If lower stiffnesses are stable, this ends the search as the limit.
            reasons.append(str(error))
            return math.nan

    limit = find_stability_limit(
        growth,
        min(max(near_N_per_m, lowest), highest),
        lowest=lowest,
        highest=highest,
        relative_tolerance=_TOLERANCE,
    ).value
    if limit == 0.0 and reasons:
        raise ValueError(reasons[0])
    return limit
