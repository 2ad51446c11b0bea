"""The loop of a held scene with a coupling of one's choice, linearized at rest."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import Context

from drake_haptics.analysis.aimed_hand import build_aimed
from drake_haptics.analysis.equilibrium import find_equilibrium
from drake_haptics.analysis.held_scene import HeldScene, hold_scene
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.sampled_linearization import (
    SampledLinearization,
    linearize_sampled,
)
from drake_haptics.analysis.simulated_growth import measure_growth
from drake_haptics.analysis.stability_limit import calc_growth, drop_neutral
from drake_haptics.common.one_line import one_line
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import Coupling, Scene

# A motion of 250 Hz turns by 0.3 rad in such a step of third order.
_STEPS_PER_TICK = 5


@dataclass(frozen=True)
class HeldLoop:
    """A haptic loop at rest, with its linear map over one tick.

    Attributes:
        haptic: The diagram.
        context: Its root context, at the equilibrium.
        linearization: Over one period, about it.
    """

    haptic: HapticDiagram
    context: Context
    linearization: SampledLinearization

    __repr__ = one_line

    @property
    def growth(self) -> float:
        """By how much the fastest growing motion is multiplied in a tick."""
        return calc_growth(self.linearization.eigenvalues())

    @on_one_blas_thread
    def measure_growth(self) -> float:
        """Returns the same, as two simulations that start side by side show it.

        Raises:
            ValueError: The motion cannot be followed; see
                `drake_haptics.analysis.simulated_growth`.
        """
        period_s = self.linearization.period_s
        A = self.linearization.A
        values, right = np.linalg.eig(A)
        fastest = int(np.argmax(np.abs(drop_neutral(values))))
        conjugates, left = np.linalg.eig(A.T)
        same = int(np.argmin(np.abs(conjugates - values[fastest])))
        return measure_growth(
            self._make_simulator,
            self.context,
            (right[:, fastest], left[:, same].conj()),
            period_s,
        )

    def _make_simulator(self, context: Context) -> Simulator:
        """Returns a simulator that is exact enough to be compared with eigenvalues."""
        simulator = Simulator(self.haptic.diagram, context)
        step_s = self.linearization.period_s / _STEPS_PER_TICK
        ResetIntegratorFromFlags(simulator, "runge_kutta3", step_s)
        simulator.get_mutable_integrator().set_fixed_step_mode(True)
        return simulator


@on_one_blas_thread
def analyse_held_scene(held: HeldScene, coupling: Coupling | None = None) -> HeldLoop:
    """Linearizes the loop of a held scene where its tool is pressed as it was held.

    Args:
        held: What `hold_scene` returned.
        coupling: Gains; the scene's own if not given.

    Raises:
        ValueError: There is no equilibrium near the place, or no derivative.
    """
    haptic, context = build_aimed(held, coupling)
    context = find_equilibrium(haptic.diagram, context).context
    return HeldLoop(haptic, context, linearize_sampled(haptic.diagram, context))


def replace_gains(coupling: Coupling, stiffness: float, damping: float) -> Coupling:
    """Returns a coupling with other gains of translation, N/m and N·s/m."""
    return replace(coupling, stiffness_N_per_m=stiffness, damping_Ns_per_m=damping)


@dataclass(frozen=True)
class CouplingGrowth:
    """Tells for a stiffness and a damping of the coupling how a held scene's loop does.

    For a `z_width`: it can be pickled, and each process holds the scene once.

    Attributes:
        scene: The scene.
        time_s: When its hand stops, s.
    """

    scene: Scene
    time_s: float

    __repr__ = one_line

    def __call__(self, stiffness: float, damping: float) -> dict[str, Any]:
        """Returns the growth per tick.

        Args:
            stiffness: Of the coupling's translation, N/m.
            damping: N·s/m.

        Raises:
            ValueError: There is no equilibrium.
        """
        held = _hold_once(self.scene, self.time_s)
        coupling = replace_gains(self.scene.coupling, stiffness, damping)
        return {"spectral_radius": analyse_held_scene(held, coupling).growth}


# One scene at a time: a diagram that Python systems are part of is never freed.
_HELD: dict[str, HeldScene] = {}


def _hold_once(scene: Scene, time_s: float) -> HeldScene:
    key = repr((asdict(scene), time_s))
    if key not in _HELD:
        _HELD.clear()
        _HELD[key] = hold_scene(scene, time_s)
    return _HELD[key]
