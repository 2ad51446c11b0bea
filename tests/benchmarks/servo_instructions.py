"""Counts the instructions of a period in which a servo solves contact.

python tests/benchmarks/servo_instructions.py [SCENE ...]

Needs valgrind; half a minute for each scene. The handle moves as recorded, at 4 kHz, in
contact, under the constraint law. Counted are the core and its binding alone:

* step: query, constraints and the tool's step, `ConstraintStepper`.
* period: that and the slopes of the wrench, `ServoTool`.
* answer: of the servo's own thread, which adopts each wrench, `ServoLaw`.
"""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
from library_counts import count_core, count_parts, run_benchmark
from scipy.spatial.transform import Rotation

from drake_haptics._core import (
    ConstraintStepper,
    CouplingGains,
    RigidToolDynamics,
    ServoLaw,
    ServoTool,
)
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.evaluation.benchmark.loop.problem import LoopProblem, make_problem
from drake_haptics.evaluation.measuring.valgrind import counted
from drake_haptics.loop.contact import find_skins

PARTS = ("step", "period", "answer")
# The shipped hands are in contact then.
_WARM_UP, _TICKS, _PER_TICK = 1200, 300, 4
_TICK_S = 1e-3
_PERIOD_S = _TICK_S / _PER_TICK
_BASE = np.eye(7)[0]


def measure(scene: str) -> dict[str, float]:
    """Returns the core's instructions in each period, by the part."""
    return {
        part: count_core(counts) / (_TICKS * _PER_TICK)
        for part, counts in count_parts(__file__, scene, PARTS).items()
    }


def run_counted(scene: str, part: str) -> None:
    """Steps until the tool is in contact, and then some ticks counted."""
    problem = make_problem(scene, _TICK_S * (_WARM_UP + _TICKS + 1))
    stepper = _make_stepper(problem)
    start = np.concatenate([problem.X_WG[0], np.zeros(6)])
    tool = ServoTool(stepper, _BASE, start)
    law = ServoLaw(max_force_N=8.5, max_torque_Nm=0.5)
    handles = [
        _move_on(q, V, k * _PERIOD_S)
        for q, V in zip(problem.motion.X_WH, problem.motion.V_WH, strict=True)
        for k in range(_PER_TICK)
    ]
    begin, end = _WARM_UP * _PER_TICK, (_WARM_UP + _TICKS) * _PER_TICK
    states, wrenches = [], []
    for q, V in handles[:end]:
        states.append(tool.state.copy())
        wrenches.append(tool.step(q, V))
    state = states[begin]
    again = ServoTool(stepper, _BASE, state)
    with counted():
        for i in range(begin, end):
            q, V = handles[i]
            if part == "step":
                stepper.step(states[i][:7], states[i][7:], q, V)
            elif part == "period":
                again.step(q, V)
            else:
                F, K, B = wrenches[i]
                law.adopt(F, q, V, K, B, i * _PERIOD_S)
                law.step(i * _PERIOD_S, q, V)


def _make_stepper(problem: LoopProblem) -> ConstraintStepper:
    scene = problem.scene
    stepper = ConstraintStepper(
        problem.tool.core,
        [item.core for item in problem.objects],
        find_skins(scene.contact, [item.material for item in scene.environment]),
        RigidToolDynamics(scene.tool.mass_kg, *problem.mass_properties()),
        CouplingGains(**asdict(scene.coupling)),
        pose_to_vector(problem.X_HT),
        _PERIOD_S,
    )
    for i, X_WO in enumerate(problem.X_WO):
        stepper.set_object_pose(i, pose_to_vector(X_WO))
    return stepper


def _move_on(
    q: np.ndarray, V: np.ndarray, time_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns a handle's pose and velocity a little later."""
    turn = Rotation.from_rotvec(time_s * V[:3]) * Rotation.from_quat(np.roll(q[:4], -1))
    return np.concatenate([np.roll(turn.as_quat(), 1), q[4:] + time_s * V[3:]]), V


def print_counts(scene: str) -> None:
    """Prints the instructions of each part."""
    print(f"| {scene}: instructions | {' | '.join(PARTS)} |")
    print(f"| --- |{' --: |' * len(PARTS)}")
    row = " | ".join(f"{count:,.0f}" for count in measure(scene).values())
    print(f"| a period | {row} |", flush=True)


if __name__ == "__main__":
    run_benchmark(PARTS, run_counted, print_counts, ["cup_spoon", "peg_in_hole"])
