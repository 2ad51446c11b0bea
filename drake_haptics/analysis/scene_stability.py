"""Analyzes a scene's stability with its tool held in contact."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_haptics.analysis.delay_margin import calc_delay_margin
from drake_haptics.analysis.felt_impedance import calc_felt_impedance
from drake_haptics.analysis.held_loop import (
    CouplingGrowth,
    HeldLoop,
    analyze_held_scene,
)
from drake_haptics.analysis.held_scene import HeldScene, hold_scene
from drake_haptics.analysis.mode_plot import plot_poles
from drake_haptics.analysis.modes import Mode, find_modes
from drake_haptics.analysis.passivity import Passivity, calc_passivity
from drake_haptics.analysis.sampled_linearization import SampledLinearization
from drake_haptics.analysis.stability_sheet import (
    plot_limits,
    plot_usage,
    put_legend_below,
)
from drake_haptics.analysis.stiffness_limits import (
    Against,
    Kind,
    StiffnessLimits,
    find_stiffness_limits,
)
from drake_haptics.analysis.z_width_map import HeldBounds, ZWidth, calc_z_width
from drake_haptics.bounds.coupling import HeldHandle
from drake_haptics.bounds.held_handle import calc_scene_handle, check_scene_coupling
from drake_haptics.common.one_line import one_line
from drake_haptics.report.plain_data import to_plain_data
from drake_haptics.scene.schema import Scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Progress = Callable[[str, float], None]

_SIZE_INCH = (13.0, 11.0)
# The smallest stiffness of the map, as a share of the largest.
_LOWEST_SHARE = 0.02
# The largest stiffness of the map, as a multiple of the largest limit and gain.
_BEYOND = 1.5


@dataclass(frozen=True)
class SceneStability:
    """Stability of a scene's loop at one place, with its device in its hand.

    Attributes:
        scene: The scene, its hand stopped.
        time_s: Time at which the hand stopped on its path, s.
        handle: Inertia and damping of device and hand at that place.
        num_contacts: Number of contacts that push at rest.
        contact_force_N: Contact force on the tool, at rest, N.
        growth: Growth of the fastest growing motion per tick; stable below 1.
        linearization: Linear map of one tick.
        modes: All motions, fastest growing first.
        delay_margin_s: Additional delay at which the loop becomes unstable, s.
        limits: Limits of the coupling's stiffness in translation and in rotation, in
            this contact, if there is one, and against a rigid wall; stiffnesses of zero
            are left out.
        felt: Damping that makes the felt impedance passive, over frequency.
        damping_usage: Share of the damping of device and hand that this requires, at
            each frequency of `felt`; passive if it is at most 1.
        broken_bounds: Sentences of `check_scene_coupling`.
        map: Growth over stiffness and damping of translation; None without a map.
        restless_s: Times of firmer contacts, s, at which the tool did not come to rest.
    """

    scene: Scene
    time_s: float
    handle: HeldHandle
    num_contacts: int
    contact_force_N: float
    growth: float
    linearization: SampledLinearization
    modes: tuple[Mode, ...]
    delay_margin_s: float
    limits: tuple[StiffnessLimits, ...]
    felt: Passivity
    damping_usage: np.ndarray
    broken_bounds: tuple[str, ...]
    map: ZWidth | None
    restless_s: tuple[float, ...] = ()

    __repr__ = one_line

    @property
    def period_s(self) -> float:
        """The tick, s."""
        return 1.0 / self.scene.device.rate_hz

    @property
    def is_stable(self) -> bool:
        """Whether every motion dies out."""
        return self.growth < 1.0

    @property
    def is_passive(self) -> bool:
        """Whether the loop cannot drive any passive hand into motion."""
        return bool(self.damping_usage.max() <= 1.0)

    def plot(self) -> Figure:
        """Draws map, poles, passivity and limits on a new figure, without a window."""
        from matplotlib.figure import Figure

        figure = Figure(figsize=_SIZE_INCH, layout="constrained")
        if self.map is None:
            panels = figure.subplot_mosaic([["poles", "usage"], ["limits", "limits"]])
        else:
            panels = figure.subplot_mosaic([["map", "poles"], ["usage", "limits"]])
            axes, coupling = panels["map"], self.scene.coupling
            self.map.plot(
                axes,
                bounds=HeldBounds(self.handle.damping_Ns_per_m, self.period_s),
                gains=(coupling.stiffness_N_per_m, coupling.damping_Ns_per_m),
            )
            rows, columns = self.map.spectral_radius.shape
            here = "in this contact" if self.num_contacts else "in free space"
            axes.set_title(
                f"couplings stable {here}, of {columns} × {rows};"
                " dashed: against a rigid wall"
            )
            axes.set_xlabel("stiffness K, N/m")
            axes.set_ylabel("damping B, N·s/m")
            put_legend_below(axes)
        plot_poles(self.linearization, panels["poles"])
        plot_usage(self.felt.frequencies_Hz, self.damping_usage, panels["usage"])
        plot_limits(self.limits, panels["limits"])
        figure.suptitle(self.scene.description)
        return figure

    def to_dict(self) -> dict[str, Any]:
        """Returns all results, ready for JSON."""
        return to_plain_data(
            {
                "description": self.scene.description,
                "device": self.scene.device.preset,
                "grip": self.scene.hand.grip,
                "coupling": self.scene.coupling,
                "period_s": self.period_s,
                "time_s": self.time_s,
                "restless_s": self.restless_s,
                "handle": self.handle,
                "num_contacts": self.num_contacts,
                "contact_force_N": self.contact_force_N,
                "growth": self.growth,
                "is_stable": self.is_stable,
                "is_passive": self.is_passive,
                "delay_margin_s": self.delay_margin_s,
                "limits": [limit.to_dict() for limit in self.limits],
                "linearization": self.linearization.to_dict(),
                "modes": [mode.to_dict() for mode in self.modes],
                "passivity": self.felt.to_dict()
                | {"damping_usage": self.damping_usage},
                "broken_bounds": self.broken_bounds,
                "map": None if self.map is None else self.map.to_dict(),
            }
        )


def analyze_scene(
    scene: Scene,
    time_s: float | None = None,
    *,
    map_size: int = 20,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> SceneStability:
    """Analyzes the stability of a scene with its tool held in contact.

    Args:
        scene: A scene with a simulated device and hand.
        time_s: Time at which the hand stops on its path, s. Defaults to the firmest
            contact.
        map_size: Number of stiffnesses and of dampings of the map, at least 2; 0 for no
            map.
        executor: Executor that computes the map, see `run_study`.
        store: Store of the map's results, see `run_study`.
        progress: Function that is called with the current work and the share done, from
            0 to 1.

    Raises:
        ValueError: The tool does not come to rest, or there is no equilibrium, or
            `map_size` is 1 or negative.
        SceneError: The scene cannot be built.
        drake_haptics.simulation.run.RunError: The scene diverges before the tool
            touches.
    """
    if map_size < 0 or map_size == 1:
        raise ValueError(f"map_size must be 0 or at least 2, is {map_size}")
    report = progress or (lambda what, share: None)
    began_s = time.perf_counter()
    held = hold_scene(scene, time_s, progress=progress)
    held_s = time.perf_counter()
    loop = analyze_held_scene(held)
    point_s = time.perf_counter() - held_s
    felt = calc_felt_impedance(loop)
    passivity = calc_passivity(felt, felt.period_s)
    contacts, force_N = _read_contact(loop)
    limits = _find_limits(held, report, contacts > 0)
    delay_margin_s = calc_delay_margin(loop)
    map_ = None
    if map_size > 0:
        what = f"map of {map_size**2} points"
        if executor is None:
            # Each process on a core holds the scene first.
            map_s = held_s - began_s + map_size**2 * point_s / (os.cpu_count() or 1)
            what += f", about {map_s:.0f} s"
        map_ = calc_z_width(
            CouplingGrowth(scene, held.time_s),
            *_choose_grid(held.scene, limits, map_size),
            executor=executor,
            store=store,
            progress=lambda done, total: report(what, done / total),
        )
    device = loop.haptic.loop.device
    return SceneStability(
        scene=held.scene,
        time_s=held.time_s,
        handle=calc_scene_handle(held.scene, device, loop.context),
        num_contacts=contacts,
        contact_force_N=force_N,
        growth=loop.growth,
        linearization=loop.linearization,
        modes=find_modes(loop.linearization),
        delay_margin_s=delay_margin_s,
        limits=limits,
        felt=passivity,
        damping_usage=passivity.calc_usage(felt.handle_damping),
        broken_bounds=tuple(check_scene_coupling(held.scene, device)),
        map=map_,
        restless_s=held.restless_s,
    )


def _find_limits(
    held: HeldScene, report: Progress, touches: bool
) -> tuple[StiffnessLimits, ...]:
    """Returns the limits of the stiffnesses that the coupling has, contact first."""
    coupling = held.scene.coupling
    kinds: list[Kind] = []
    if coupling.stiffness_N_per_m > 0.0:
        kinds.append("translation")
    if coupling.rotational_stiffness_Nm_per_rad > 0.0:
        kinds.append("rotation")
    cases: list[Against] = ["this contact"] if touches else []
    cases.append("a rigid wall")
    return tuple(
        find_stiffness_limits(
            held, kind, against, partial(report, f"limit of {kind} against {against}")
        )
        for against in cases
        for kind in kinds
    )


def _choose_grid(
    scene: Scene, limits: tuple[StiffnessLimits, ...], size: int
) -> tuple[np.ndarray, np.ndarray]:
    """Returns stiffnesses (N/m) and dampings (N·s/m) around the stable ones."""
    coupling = scene.coupling
    found = [
        value
        for limit in limits
        if limit.kind == "translation"
        for value in (limit.eigenvalue, limit.stiffness)
        if np.isfinite(value)
    ]
    highest = _BEYOND * max(found, default=1000.0)
    lowest = min(_LOWEST_SHARE * highest, 0.5 * (coupling.stiffness_N_per_m or highest))
    most = 4.0 * max(coupling.damping_Ns_per_m, 1.0)
    return np.geomspace(lowest, highest, size), np.linspace(0.0, most, size)


def _read_contact(loop: HeldLoop) -> tuple[int, float]:
    """Returns the number of contacts that push and their force on the tool, N."""
    parts, root = loop.haptic.loop, loop.context
    diagram = loop.haptic.diagram
    contacts = diagram.GetOutputPort("contacts").Eval(root)
    # The force begins at the tolerance; under the constraint law all contacts push.
    tolerance_m = math.inf
    if parts.penalty is not None:
        tolerance_m = parts.penalty.read_tolerance(root)
    pushing = contacts.distance < tolerance_m
    wrench = diagram.GetOutputPort("F_To_W").Eval(root)
    return int(pushing.sum()), float(np.linalg.norm(wrench[3:]))
