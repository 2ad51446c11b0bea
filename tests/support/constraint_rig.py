"""A tool held by a coupling and kept off solids by constraints, without Drake."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import cycle

import numpy as np
from press_rig import START_M, Press, sample_presses
from press_tools import PressTool, make_tools

from drake_haptics import _core
from drake_haptics.geometry.mesh.mesh import Mesh

PERIOD_S = 1e-3
SKIN_M = 3e-4
COUPLING = _core.CouplingGains(800.0, 2.0, 1.0, 4e-3)
REST = np.array([1.0, 0, 0, 0, 0, 0, 0])


class ConstraintLoop:
    """Steps a tool by a handle that holds it at its frame's origin.

    Attributes:
        q_WT: Pose (7,) of the tool.
        V_WT: Spatial velocity (6,) of the tool, rad/s and m/s.
        q_WH: Pose (7,) of the handle at the last tick.
        work_J: Work of contact on the tool in each tick, J.
        anchors: Anchors of friction, where there is some.
    """

    def __init__(
        self,
        tool: PressTool,
        solids: Sequence[_core.ConvexPieces],
        q_WT: np.ndarray,
        *,
        skin_m: float = SKIN_M,
        gains: _core.CouplingGains = COUPLING,
        coefficient: float | None = None,
        period_s: float = PERIOD_S,
    ) -> None:
        self._period_s = period_s
        self.stepper = _core.ConstraintStepper(
            tool.core,
            list(solids),
            [skin_m] * len(solids),
            tool.dynamics,
            gains,
            REST,
            period_s,
            coefficient=[] if coefficient is None else [coefficient] * len(solids),
        )
        self.anchors = np.zeros(self.stepper.num_anchors)
        self.q_WT = np.array(q_WT, dtype=float)
        self.V_WT = np.zeros(6)
        self.q_WH = self.q_WT.copy()
        self.work_J: list[float] = []

    def tick(
        self,
        q_WH: np.ndarray,
        V_WH: np.ndarray | None = None,
        F_applied: np.ndarray | None = None,
    ) -> _core.ConstraintStepResult:
        """Advances by a tick, in which the handle does not turn unless V_WH is given.

        Args:
            q_WH: Pose (7,) of the handle at the tick's end.
            V_WH: Spatial velocity (6,) of the handle. Defaults to its motion since the
                last tick.
            F_applied: Other wrenches (6,) on the tool. Defaults to none.
        """
        if V_WH is None:
            move = (q_WH[4:] - self.q_WH[4:]) / self._period_s
            V_WH = np.concatenate([np.zeros(3), move])
        self.q_WH = np.array(q_WH, dtype=float)
        F = np.zeros(6) if F_applied is None else F_applied
        result = self.stepper.step(
            self.q_WT, self.V_WT, self.q_WH, V_WH, F, self.anchors
        )
        self.anchors = result.friction.next_state
        power_W = contact_wrench(result, self.q_WT[4:]) @ result.V_WT
        self.work_J.append(power_W * self._period_s)
        self.q_WT, self.V_WT = result.q_WT, result.V_WT
        return result


def contact_wrench(result: _core.ConstraintStepResult, p_WTo: np.ndarray) -> np.ndarray:
    """Returns the wrench of all rows on the tool at To, (6,) N·m and N."""
    f = result.lambda_N[:, None] * result.contacts.nhat_BA_W
    arms = result.contacts.p_WCa - p_WTo
    return np.concatenate([np.cross(arms, f).sum(axis=0), f.sum(axis=0)])


def take_turns(mesh: Mesh) -> Iterator[tuple[PressTool, Press]]:
    """Yields presses of four tools in turn on a surface, without end."""
    tools = make_tools()
    kinds = cycle(("spike", "ball", "box", "spoon"))
    for number, kind in enumerate(kinds):
        [press] = sample_presses(mesh, tools[kind], "press", [number], 7)
        yield tools[kind], press


def check_led_out(loop: ConstraintLoop, q_WH: np.ndarray, num_ticks: int) -> None:
    """Asserts that a tool comes out with less than 3 N on the hand and no kick."""
    for _ in range(num_ticks):
        result = loop.tick(q_WH)
        assert np.linalg.norm(result.F_Ho_W_commanded[3:]) < 3.0
        assert np.linalg.norm(result.V_WT[3:]) < 0.1
    assert result.is_apart


def run_press(
    loop: ConstraintLoop, press: Press
) -> Iterator[_core.ConstraintStepResult]:
    """Each tick of a press: in until it resists as much as it stops at, a rest, out."""
    step_m = press.speed_m_per_s * PERIOD_S
    travel_m = force_N = 0.0
    while travel_m < START_M + press.stop_m and force_N < press.stop_N:
        travel_m += step_m
        result = loop.tick(press.q_WH(travel_m, 0.0))
        force_N = float(np.linalg.norm(result.F_Ho_W_commanded[3:]))
        yield result
    for _ in range(200):
        yield loop.tick(press.q_WH(travel_m, 0.0))
    while travel_m > 0:
        travel_m -= step_m
        yield loop.tick(press.q_WH(travel_m, 0.0))
