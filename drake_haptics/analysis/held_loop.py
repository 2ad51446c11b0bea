"""Linearizes the loop of a held scene at rest, with any coupling.

The hand's pose is adapted, so that other gains hold the tool in the same contact.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from pydrake.common.eigen_geometry import AngleAxis
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import Context

from drake_haptics.analysis.equilibrium import find_equilibrium
from drake_haptics.analysis.held_scene import (
    HeldScene,
    build_without_scene_warnings,
    hold_scene,
    to_scene_pose,
)
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.sampled_linearization import (
    SampledLinearization,
    linearize_sampled,
)
from drake_haptics.analysis.stability_limit import (
    calc_growth,
    drop_neutral,
    measure_growth,
)
from drake_haptics.common.one_line import one_line
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import (
    CouplingParameters,
    HandPathParameters,
    Scene,
    Waypoint,
)
from drake_haptics.simulation.live_values import write_live_values
from drake_haptics.simulation.transfer_state import move_handle, release_diagram
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS
from drake_haptics.systems.arm.simulated_arm import UnreachableError

# Largest angle of a rotational spring, rad; beyond half a turn it would pull back.
_LARGEST_TWIST = 2.5
# Loads smaller than this need no spring to hold them, N and N·m.
_NO_LOAD = 1e-9


def build_with_same_load(
    held: HeldScene, coupling: CouplingParameters | None = None
) -> tuple[HapticDiagram, Context]:
    """Builds a held scene with other gains and the same load on the tool.

    A stiffer coupling with the same stretch would press harder, and the tool would rest
    elsewhere. So handle and hand are moved until their springs load the tool with the
    same wrench.

    Returns:
        The diagram, and its root context at rest up to round-off.

    Raises:
        ValueError: A spring without stiffness would have to hold a load, a spring would
            turn too far, or the pose is out of the device's reach.
        SceneError: The hand would leave the device's workspace.
    """
    coupling = coupling or held.scene.coupling
    X_WH, X_WP, F_Ho_W = _aim(held, coupling)
    at = to_scene_pose(X_WP)
    path = HandPathParameters(waypoints=[Waypoint(0.0, at.position_m, at.rpy_deg)])
    scene = replace(
        held.scene, coupling=coupling, hand=replace(held.scene.hand, path=path)
    )
    haptic = build_without_scene_warnings(scene)
    context = haptic.diagram.CreateDefaultContext()
    context.SetTimeStateAndParametersFrom(held.context)
    # Gains are parameters, too, so those of the held scene were just copied.
    write_live_values(haptic, context, scene)
    try:
        move_handle(haptic, context, X_WH)
    except UnreachableError as error:
        raise ValueError(f"to press as before: {error}") from error
    hold = haptic.loop.device.GetSubsystemByName("rendered_force_hold")
    hold.GetMyMutableContextFromRoot(context).SetDiscreteState(np.append(F_Ho_W, 0.0))
    return haptic, context


def _aim(
    held: HeldScene, coupling: CouplingParameters
) -> tuple[RigidTransform, RigidTransform, np.ndarray]:
    """Solves the springs of coupling and hand for the load on the tool.

    Returns:
        Poses of handle and hand, and the wrench on the handle.
    """
    torque, force = held.F_To_W[:3], held.F_To_W[3:]
    X_HT = held.scene.tool.grasp.to_rigid_transform()
    X_Wheld = _stretch(
        held.X_WT,
        torque,
        force,
        coupling.rotational_stiffness_Nm_per_rad,
        coupling.stiffness_N_per_m,
        "coupling",
    )
    X_WH = X_Wheld @ X_HT.inverse()
    p_HT_W = X_WH.rotation() @ X_HT.translation()
    torque_on_hand = torque + np.cross(p_HT_W, force)
    grip = HAND_GRIPS[held.scene.hand.grip]
    X_Wwanted = _stretch(
        X_WH,
        torque_on_hand,
        force,
        grip.rotational_stiffness_Nm_per_rad if grip else 0.0,
        grip.stiffness_N_per_m if grip else 0.0,
        "hand",
    )
    return X_WH, X_Wwanted @ X_HT, -np.concatenate([torque_on_hand, force])


def _stretch(
    X_WB: RigidTransform,
    torque: np.ndarray,
    force: np.ndarray,
    rotational_stiffness: float,
    stiffness: float,
    whose: str,
) -> RigidTransform:
    """Returns the pose of a spring's other end at which it loads B as given."""
    for load, k in [(torque, rotational_stiffness), (force, stiffness)]:
        if k == 0.0 and np.linalg.norm(load) > _NO_LOAD:
            raise ValueError(
                f"the {whose} has no spring to hold the tool with"
                f" {np.linalg.norm(force):.3g} N and {np.linalg.norm(torque):.3g} N·m"
            )
    twist = torque / (rotational_stiffness or 1.0)
    angle = float(np.linalg.norm(twist))
    if angle > _LARGEST_TWIST:
        raise ValueError(
            f"the {whose}'s spring would be turned by {angle:.2f} rad to hold the tool"
            f" with {np.linalg.norm(torque):.3g} N·m: more than {_LARGEST_TWIST} rad"
        )
    turn = RotationMatrix()
    if angle > 0.0:
        turn = RotationMatrix(AngleAxis(angle, twist / angle))
    return RigidTransform(
        turn @ X_WB.rotation(), X_WB.translation() + force / (stiffness or 1.0)
    )


# An oscillation of 250 Hz advances by 0.3 rad in a step of the third-order integrator.
_STEPS_PER_TICK = 5


@dataclass(frozen=True)
class HeldLoop:
    """A haptic loop at rest, with its linear map over one tick.

    Attributes:
        haptic: The diagram.
        context: Its root context, at the equilibrium.
        linearization: Linearization over one period about the equilibrium.
    """

    haptic: HapticDiagram
    context: Context
    linearization: SampledLinearization

    __repr__ = one_line

    @property
    def growth(self) -> float:
        """Factor by which the fastest growing motion is multiplied per tick."""
        return calc_growth(self.linearization.eigenvalues())

    @on_one_blas_thread
    def measure_growth(self) -> float:
        """Returns the growth per tick from two simulations with nearby initial states.

        Raises:
            ValueError: The motion cannot be followed; see
                `drake_haptics.analysis.stability_limit`.
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
        """Returns a simulator that is accurate enough to compare with eigenvalues."""
        simulator = Simulator(self.haptic.diagram, context)
        step_s = self.linearization.period_s / _STEPS_PER_TICK
        ResetIntegratorFromFlags(simulator, "runge_kutta3", step_s)
        simulator.get_mutable_integrator().set_fixed_step_mode(True)
        return simulator


@on_one_blas_thread
def analyze_held_scene(
    held: HeldScene, coupling: CouplingParameters | None = None
) -> HeldLoop:
    """Linearizes the loop of a held scene with the same load on the tool.

    Args:
        held: The result of `hold_scene`.
        coupling: Gains of the coupling. Defaults to the scene's.

    Raises:
        ValueError: There is no equilibrium nearby, or no derivative.
    """
    haptic, context = build_with_same_load(held, coupling)
    context = find_equilibrium(haptic.diagram, context).context
    return HeldLoop(haptic, context, linearize_sampled(haptic.diagram, context))


def replace_gains(
    coupling: CouplingParameters, stiffness: float, damping: float
) -> CouplingParameters:
    """Returns a coupling with other gains of translation, N/m and N·s/m."""
    return replace(coupling, stiffness_N_per_m=stiffness, damping_Ns_per_m=damping)


@dataclass(frozen=True)
class CouplingGrowth:
    """Calculates the growth of a held scene's loop for a stiffness and a damping.

    It is made for `calc_z_width`: it can be pickled, and each process holds the scene
    once.

    Attributes:
        scene: The scene.
        time_s: Time at which the hand stops, s.
    """

    scene: Scene
    time_s: float

    __repr__ = one_line

    def __call__(self, stiffness: float, damping: float) -> dict[str, Any]:
        """Returns the growth per tick.

        Args:
            stiffness: Stiffness of the coupling in translation, N/m.
            damping: Damping of the coupling in translation, N·s/m.

        Raises:
            ValueError: There is no equilibrium.
        """
        held = _hold_once(self.scene, self.time_s)
        coupling = replace_gains(self.scene.coupling, stiffness, damping)
        loop = analyze_held_scene(held, coupling)
        growth = loop.growth
        release_diagram(loop.haptic)
        return {"spectral_radius": growth}


# Only one scene is kept: a diagram with Python systems is never freed.
_HELD: dict[str, HeldScene] = {}


def _hold_once(scene: Scene, time_s: float) -> HeldScene:
    key = repr((asdict(scene), time_s))
    if key not in _HELD:
        _HELD.clear()
        _HELD[key] = hold_scene(scene, time_s)
    return _HELD[key]
