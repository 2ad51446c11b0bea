"""Tabulates the cost of each part of the twin in stable stiffness of a coupling.

python docs/generate/twin_table.py --write
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import Context

from drake_haptics.analysis.held_scene import build_without_scene_warnings, stop_hand
from drake_haptics.analysis.sampled_linearization import linearize_sampled
from drake_haptics.analysis.stability_limit import calc_growth, find_stability_limit
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import (
    DeviceImperfections,
    EncoderParameters,
    ForceDelayParameters,
    HandPathParameters,
    JointFrictionParameters,
    SaturationParameters,
    Scene,
)

PAGE = Path(__file__).parents[2] / "docs" / "device-twin.md"
HEAD = [
    "`device.twin`",
    "eigenvalue, N/m",
    "simulation, N/m",
    "of the ideal device",
    "left at 800 N/m, µm",
]
TWINS = {
    "none": DeviceImperfections(),
    "delay of 1": DeviceImperfections(delay=ForceDelayParameters(1)),
    "delay of 2": DeviceImperfections(delay=ForceDelayParameters(2)),
    "saturation": DeviceImperfections(saturation=SaturationParameters()),
    "encoder, window of 1": DeviceImperfections(
        encoder=EncoderParameters(velocity_window=1)
    ),
    "encoder, window of 4": DeviceImperfections(encoder=EncoderParameters()),
    "encoder, window of 16": DeviceImperfections(
        encoder=EncoderParameters(velocity_window=16)
    ),
    "friction": DeviceImperfections(friction=JointFrictionParameters()),
    "encoder of 4 and friction": DeviceImperfections(
        encoder=EncoderParameters(), friction=JointFrictionParameters()
    ),
    "all, with a delay of 1": DeviceImperfections(
        EncoderParameters(),
        JointFrictionParameters(),
        ForceDelayParameters(1),
        SaturationParameters(),
    ),
}
_SCENE, _HELD_AT_S = "cup_spoon", 1.724
# A tool of this mass, kg, is a rigid wall for the coupling.
_IMMOVABLE_KG = 1e15
# The handle is knocked this fast, m/s, and must be at rest after so long, s, but for so
# much, m: some steps of the encoders.
_KNOCK = 0.05
_REST_S, _LAST_S = 2.0, 0.2
_AT_REST = 1e-4
# Ratio of two stiffnesses that are told apart.
_CLOSE = 1.01
# Of third order, so that what grows is the loop and not the integrator's error.
_STEPS_PER_TICK = 2


def make_scene(twin: DeviceImperfections, stiffness: float) -> Scene:
    """Returns the scene, its hand and its tool standing still."""
    scene = stop_hand(load_scene(find_scene(_SCENE)), _HELD_AT_S)
    place = replace(scene.hand.path.waypoints[-1], time_s=0.0)
    return replace(
        scene,
        tool=replace(scene.tool, mass_kg=_IMMOVABLE_KG),
        coupling=replace(scene.coupling, stiffness_N_per_m=stiffness),
        device=replace(scene.device, twin=twin),
        hand=replace(scene.hand, path=HandPathParameters(waypoints=[place])),
    )


def find_eigenvalue_limit(twin: DeviceImperfections) -> float:
    """Returns the stiffness at which an eigenvalue reaches 1, NaN without any."""
    if twin.encoder is not None or twin.friction is not None:
        return math.nan

    def growth(stiffness: float) -> float:
        diagram = build_without_scene_warnings(make_scene(twin, stiffness)).diagram
        linear = linearize_sampled(diagram, diagram.CreateDefaultContext())
        return calc_growth(linear.eigenvalues())

    return find_stability_limit(growth, 5e3, lowest=100.0, highest=1e6).value


def find_simulated_limit(twin: DeviceImperfections) -> float:
    """Returns the stiffness up to which a knock dies out, N/m."""
    low, high = 100.0, 1e5
    while high > _CLOSE * low:
        middle = math.sqrt(low * high)
        if measure_swing(twin, middle) < _AT_REST:
            low = middle
        else:
            high = middle
    return math.sqrt(low * high)


def measure_swing(twin: DeviceImperfections, stiffness: float) -> float:
    """Returns the motion of the handle that is left some time after a knock, m."""
    haptic = build_without_scene_warnings(make_scene(twin, stiffness))
    simulator = Simulator(haptic.diagram)
    step_s = haptic.period_s / _STEPS_PER_TICK
    ResetIntegratorFromFlags(simulator, "runge_kutta3", step_s)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    plant = _get_plant(haptic)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    handle = plant.GetBodyByName("handle")
    plant.SetVelocities(context, _calc_knock(haptic, context))
    positions: list[np.ndarray] = []

    def note(_: object) -> None:
        positions.append(plant.EvalBodyPoseInWorld(context, handle).translation())

    simulator.AdvanceTo(_REST_S - _LAST_S)
    simulator.set_monitor(note)
    try:
        simulator.AdvanceTo(_REST_S)
    except FloatingPointError:
        return math.inf
    return float(np.linalg.norm(np.ptp(positions, axis=0)))


def _get_plant(haptic: HapticDiagram) -> MultibodyPlant:
    arm = haptic.loop.device.GetSubsystemByName("simulated_arm")
    return arm.GetSubsystemByName("arm")


def _calc_knock(haptic: HapticDiagram, context: Context) -> np.ndarray:
    """Returns joint speeds that move the handle in all directions alike."""
    plant = _get_plant(haptic)
    J_WH = plant.CalcJacobianSpatialVelocity(
        context,
        JacobianWrtVariable.kV,
        plant.GetFrameByName("handle"),
        np.zeros(3),
        plant.world_frame(),
        plant.world_frame(),
    )
    V_WH = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]) * _KNOCK / math.sqrt(3.0)
    return np.linalg.solve(J_WH, V_WH)


def rows() -> Iterable[list[str]]:
    """Yields the table's rows, the head first."""
    yield HEAD
    ideal = math.nan
    for name, twin in TWINS.items():
        print(name, file=sys.stderr)
        limit = find_simulated_limit(twin)
        ideal = limit if name == "none" else ideal
        by_eigenvalue = find_eigenvalue_limit(twin)
        yield [
            name,
            f"{by_eigenvalue:.0f}" if math.isfinite(by_eigenvalue) else "",
            f"{limit:.0f}",
            f"{100.0 * limit / ideal:.0f} %",
            f"{1e6 * measure_swing(twin, 800.0):.2f}",
        ]


def main() -> None:
    """Prints the table, and writes it into the page if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    table = to_markdown(rows())
    show_parts(PAGE, {"costs": table}, __file__, write)


if __name__ == "__main__":
    main()
