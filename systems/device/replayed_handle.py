"""A device backend that replays the motion of a recorded handle."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context, Diagram, LeafSystem

from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.framework.vector_ports import BuildAround


class ReplayedHandle(Diagram):
    """The handle of a recorded run, tick by tick, bit for bit.

    .. pydrake_system::

        name: ReplayedHandle
        input_ports:
        - F_Ho_W_rendered
        output_ports:
        - X_WH
        - V_WH

    * `F_Ho_W_rendered` (6) is ignored: a recorded hand does not yield.
    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m.
    * `V_WH` (6) is its spatial velocity [ω; v] in the world, rad/s and m/s.

    From tick k to the next one both are as the updates of tick k saw them when the run
    was recorded; after the last tick they stay the same.
    """

    def __init__(self, X_WH: np.ndarray, V_WH: np.ndarray, period_s: float):
        """Constructs the system.

        Args:
            X_WH: (n, 7) poses of the handle at each tick, n at least 1; quaternions of
                any length but zero.
            V_WH: (n, 6) spatial velocities of the handle.
            period_s: The tick, s.

        Raises:
            ValueError: There are no ticks, the arrays differ in length or have the
                wrong width, a quaternion is zero, or the period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        if not len(X_WH) == len(V_WH) > 0:
            raise ValueError(
                f"X_WH and V_WH must have equally many ticks, at least one, have"
                f" {len(X_WH)} and {len(V_WH)}"
            )
        for name, rows, width in [("X_WH", X_WH, 7), ("V_WH", V_WH, 6)]:
            if np.shape(rows)[1:] != (width,):
                raise ValueError(
                    f"{name} must have shape (n, {width}), has {np.shape(rows)}"
                )
        # A handle that was lost is NaN, which the loop reports when it comes to it.
        zero = np.flatnonzero(~np.any(np.asarray(X_WH)[:, :4], axis=1))
        if len(zero):
            raise ValueError(
                f"X_WH[{zero[0]}] has a quaternion of zero, which no pose has"
            )
        motion = _RecordedMotion(np.hstack([X_WH, V_WH]), period_s)
        BuildAround(self, "motion", motion, {"X_WH": 7, "V_WH": 6})


class _RecordedMotion(LeafSystem):
    """[X_WH; V_WH] as a function of time."""

    def __init__(self, states: np.ndarray, period_s: float):
        super().__init__()
        self._states = states
        self._period_s = period_s
        self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self.DeclareVectorOutputPort(
            "handle_state", 13, self._calc_handle_state, {self.time_ticket()}
        )

    def _calc_handle_state(self, context: Context, output: BasicVector) -> None:
        # Between ticks the last one holds; round-off at a tick must not matter.
        tick = int(context.get_time() / self._period_s + 1e-6)
        output.SetFromVector(self._states[min(tick, len(self._states) - 1)])
