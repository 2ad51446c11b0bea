"""A tool held by a coupling and kept off solids by constraints, without Drake."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from press_tools import PressTool

from drake_haptics import _core

PERIOD_S = 1e-3
SKIN_M = 3e-4
COUPLING = _core.CouplingGains(800.0, 2.0, 1.0, 4e-3)
REST = np.array([1.0, 0, 0, 0, 0, 0, 0])


class ConstraintLoop:
    """Steps a tool by a handle that holds it at its frame's origin.

    Attributes:
        q_WT: Pose (7,) of the tool.
        V_WT: Its spatial velocity (6,), rad/s and m/s.
        q_WH: Pose (7,) of the handle at the last tick.
        work_J: Of each tick, what contact did on the tool.
        results: Of each tick, where asked for.
    """

    def __init__(
        self,
        tool: PressTool,
        solids: Sequence[_core.ConvexPieces],
        q_WT: np.ndarray,
        *,
        skin_m: float = SKIN_M,
        gains: _core.CouplingGains = COUPLING,
    ) -> None:
        self.stepper = _core.ConstraintStepper(
            tool.core,
            list(solids),
            [skin_m] * len(solids),
            tool.dynamics,
            gains,
            REST,
            PERIOD_S,
        )
        self.q_WT = np.array(q_WT, dtype=float)
        self.V_WT = np.zeros(6)
        self.q_WH = self.q_WT.copy()
        self.work_J: list[float] = []

    def tick(
        self, q_WH: np.ndarray, V_WH: np.ndarray | None = None
    ) -> _core.ConstraintStepResult:
        """Advances by a tick in which the handle turns by nothing unless it is said.

        Args:
            q_WH: Pose (7,) of the handle at the tick's end.
            V_WH: Its spatial velocity (6,). Defaults to its motion since the last.
        """
        if V_WH is None:
            move = (q_WH[4:] - self.q_WH[4:]) / PERIOD_S
            V_WH = np.concatenate([np.zeros(3), move])
        self.q_WH = np.array(q_WH, dtype=float)
        result = self.stepper.step(self.q_WT, self.V_WT, self.q_WH, V_WH)
        self.work_J.append(contact_wrench(result, self.q_WT[4:]) @ result.V_WT * 1e-3)
        self.q_WT, self.V_WT = result.q_WT, result.V_WT
        return result


def contact_wrench(
    result: _core.ConstraintStepResult, p_WTo: np.ndarray
) -> np.ndarray:
    """What all rows push with on the tool at To, (6,) N·m and N."""
    f = result.lambda_N[:, None] * result.contacts.nhat_BA_W
    arms = result.contacts.p_WCa - p_WTo
    return np.concatenate([np.cross(arms, f).sum(axis=0), f.sum(axis=0)])
