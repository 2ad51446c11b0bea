"""Stops the hand of a scene on its path, to analyze the scene there."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.framework import Context

from drake_haptics.analysis.equilibrium import find_equilibrium
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.preconditions import check_conversion
from drake_haptics.common.one_line import one_line
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.common.value_checks import check_at_least
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.loop.simulated_device import make_hand_path, place_base
from drake_haptics.scene.schema import (
    CouplingParameters,
    HandPathParameters,
    Pose,
    Scene,
    Waypoint,
)
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.run import RunError, make_simulator, run
from drake_haptics.systems.device.haptic_device import HapticDevice

# Shortest time in which a hand stops.
_SHORTEST_STOP_S = 0.05
# Number of places at which the tool is held until it rests at one, and the shortest
# time between them.
_MOST_PLACES = 6
_APART_S = 0.05
# Number of softer couplings that are tried for a loop that does not settle.
_MOST_SOFTENINGS = 8
# A tool that moves no faster, m/s and rad/s, has settled.
_SETTLED_SPEED = 5e-3
# A tool of this mass, kg, is held still by whatever it touches.
_IMMOVABLE_KG = 1e15


@dataclass(frozen=True)
class HeldScene:
    """A scene at rest, whose hand holds the tool at a place on its path.

    Attributes:
        scene: Scene whose path ends at that place.
        time_s: Time at which the hand stops, s.
        context: Root context of the scene's diagram, at rest.
        X_WT: Pose of the tool at rest.
        F_To_W: Spatial force (6,) of the coupling on the tool there, [N·m; N], at the
            tool's origin in the world.
        restless_s: Times of firmer contacts, s, at which the tool did not come to rest.
    """

    scene: Scene
    time_s: float
    context: Context
    X_WT: RigidTransform
    F_To_W: np.ndarray
    restless_s: tuple[float, ...] = ()

    __repr__ = one_line

    def against_rigid_wall(self) -> HeldScene:
        """Returns the held scene with a tool that cannot move.

        A rigid wall is the worst case for stability. The coupling still pulls the
        handle to the tool; the tool is too heavy to follow, and gravity is left out.
        `analyze_held_scene` returns the loop.
        """
        scene = replace(
            self.scene,
            tool=replace(self.scene.tool, mass_kg=_IMMOVABLE_KG),
            effects=replace(self.scene.effects, gravity=None),
        )
        return replace(self, scene=scene)


@on_one_blas_thread
def find_firmest_contact(scene: Scene) -> float:
    """Returns the time at which the tool is pressed hardest along the hand's path, s.

    One lap of the path is simulated. If the tool touches nothing, the result is the
    time at which it is nearest to an object; if nothing is near, the end of the path.

    Raises:
        drake_haptics.simulation.run.RunError: The scene diverges before it touches.
    """
    return _find_firm_places(scene)[0]


@on_one_blas_thread
def hold_scene(
    scene: Scene,
    time_s: float | None = None,
    *,
    settle_s: float = 1.0,
    progress: Callable[[str, float], None] | None = None,
) -> HeldScene:
    """Stops a scene's hand on its path and lets the tool come to rest.

    The path until then is simulated as in a run, so that the tool touches from the side
    from which it came. If the tool does not settle with the scene's coupling, softer
    ones are tried; `drake_haptics.analysis.held_loop.build_with_same_load` then
    restores the scene's.

    Args:
        scene: The scene to hold.
        time_s: Time at which the hand stops, s; on a periodic path, in the first lap.
            Defaults to the time of the firmest contact at which the tool comes to rest;
            on a ridge it may rock between two facets forever.
        settle_s: Time for the tool to come to rest, s.
        progress: Function that is called with the current work and the share done, from
            0 to 1.

    Raises:
        ValueError: A time is negative or not on the path, the tool does not come to
            rest, or a part of the scene has no derivatives.
        SceneError: The scene cannot be built.
    """
    # Drake ends the program for a time in the past.
    check_at_least(0, settle_s=settle_s)
    report = progress or (lambda what, share: None)
    # Otherwise the search for an equilibrium would fail without a reason.
    check_conversion(build_without_scene_warnings(scene).diagram)
    report("looking for the firmest contact", 0.0)
    places = _find_firm_places(scene) if time_s is None else [time_s]
    coupling = scene.coupling
    for softening in range(_MOST_SOFTENINGS + 1):
        for i, place in enumerate(places):
            report(f"stopping the hand at {place:.3f} s", softening / _MOST_SOFTENINGS)
            held = stop_hand(scene, place)
            found = _settle(replace(held, coupling=coupling), place + settle_s)
            if found is not None:
                return HeldScene(held, place, *found, tuple(places[:i]))
        coupling = _soften(coupling)
    raise ValueError(
        f"the tool does not come to rest within {settle_s:g} s after the hand stops at"
        f" {', '.join(f'{place:.3f}' for place in places)} s, even with a much"
        " softer coupling: give another time or a longer settle_s,"
        " or lower contact.stiffness_N_per_m"
    )


def _find_firm_places(scene: Scene) -> list[float]:
    """Returns times at which the tool is pressed, the firmest first."""
    haptic = build_without_scene_warnings(scene)
    F_To_W = haptic.diagram.GetOutputPort("F_To_W")
    # The force of the hand; that of contact is largest on impact.
    F_Ho_W = haptic.diagram.GetOutputPort("F_Ho_W_commanded")
    contacts = haptic.diagram.GetOutputPort("contacts")
    pressed: list[tuple[float, float]] = []

    def note(root: Context) -> None:
        if F_To_W.Eval(root)[3:].any():
            firmness = float(np.linalg.norm(F_Ho_W.Eval(root)[3:]))
        else:
            firmness = -contacts.Eval(root).least_distance
        pressed.append((firmness, root.get_time()))

    duration_s = make_hand_path(scene.hand.path).duration_s
    try:
        run(haptic, duration_s, on_tick=note)
    except RunError:
        if not any(firmness > 0.0 for firmness, _ in pressed):
            raise
    places: list[float] = []
    for firmness, place in sorted(pressed, reverse=True):
        far = all(abs(place - other) >= _APART_S for other in places)
        if far and len(places) < _MOST_PLACES and math.isfinite(firmness):
            places.append(min(place, duration_s))
    return places or [duration_s]


def stop_hand(scene: Scene, time_s: float) -> Scene:
    """Returns a scene whose hand follows its path and stops at a time.

    Args:
        scene: Scene to change; the device's base does not move.
        time_s: Time of the stop, s, not after the path's end.

    Raises:
        ValueError: The time is not on the path.
    """
    path = make_hand_path(scene.hand.path)
    if not 0.0 <= time_s <= path.duration_s + 1e-9:
        raise ValueError(
            f"time_s must be on the hand's path, from 0 to {path.duration_s:g} s, is"
            f" {time_s:g}"
        )
    stop = to_scene_pose(vector_to_pose(path.calc(time_s)[0]))
    waypoints = [
        waypoint
        for waypoint in scene.hand.path.waypoints
        if waypoint.time_s <= time_s - _SHORTEST_STOP_S
    ]
    if waypoints:
        waypoints.append(Waypoint(time_s, stop.position_m, stop.rpy_deg))
    else:
        waypoints = [Waypoint(0.0, stop.position_m, stop.rpy_deg)]
    return replace(
        scene,
        device=replace(
            scene.device,
            base=to_scene_pose(place_base(scene, path)),
            # The result must not depend on the speed of the machine.
            tick_budget_us=None,
        ),
        hand=replace(
            scene.hand, path=HandPathParameters(periodic=False, waypoints=waypoints)
        ),
    )


def _settle(
    scene: Scene, until_s: float
) -> tuple[Context, RigidTransform, np.ndarray] | None:
    """Returns where a scene's tool rests, or None if it does not come to rest."""
    haptic = build_without_scene_warnings(scene)
    simulator = make_simulator(haptic)
    try:
        simulator.AdvanceTo(until_s)
    except FloatingPointError:
        return None
    coupling = haptic.loop.coupling_model
    context = simulator.get_context()
    velocity = haptic.diagram.GetOutputPort("V_WT").Eval(context)
    # This is also true for NaN.
    if not np.abs(velocity).max() < _SETTLED_SPEED:
        return None
    try:
        context = find_equilibrium(haptic.diagram, context).context
    except ValueError:
        return None
    pose = haptic.diagram.GetOutputPort("X_WT").Eval(context)
    model = coupling.Eval(coupling.get_system().GetMyContextFromRoot(context))
    return context, vector_to_pose(pose), np.array(model[:6])


def _soften(coupling: CouplingParameters) -> CouplingParameters:
    """Returns gains lowered to the defaults, or halved if no gain is above them.

    The defaults are stable on the shipped device.
    """
    gains, defaults = asdict(coupling), asdict(CouplingParameters())
    softer = {name: min(gain, defaults[name]) for name, gain in gains.items()}
    if softer == gains:
        softer = {name: gain / 2.0 for name, gain in gains.items()}
    return CouplingParameters(**softer)


def build_without_scene_warnings(
    scene: Scene, device: HapticDevice | DeviceBackend | None = None
) -> HapticDiagram:
    """Builds a scene without warnings, since the analysis determines stability."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SceneWarning)
        return BuildHapticDiagram(scene, device=device)


def to_scene_pose(X_WF: RigidTransform) -> Pose:
    """Returns a pose in the form of a scene."""
    rpy_deg = np.rad2deg(RollPitchYaw(X_WF.rotation()).vector())
    return Pose(X_WF.translation().tolist(), rpy_deg.tolist())
