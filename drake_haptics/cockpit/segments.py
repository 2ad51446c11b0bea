"""A run in segments: of each another diagram goes on where the last one ended."""

from __future__ import annotations

from collections.abc import Callable

from pydrake.math import RigidTransform
from pydrake.systems.framework import Context

from drake_haptics.builder import HapticDiagram
from drake_haptics.carry_on import carry_on, find_handle
from drake_haptics.cockpit.cockpit import Change, Cockpit
from drake_haptics.cockpit.holding import Holding
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.errors import UserError
from drake_haptics.pose_vector import vector_to_pose
from drake_haptics.run_statistics import RunStatistics
from drake_haptics.scene import Scene
from drake_haptics.simulation import run
from drake_haptics.tick_clock import TickClock


class Segments:
    """Runs a scene, and what becomes of it on the cockpit's page."""

    def __init__(
        self,
        haptic: HapticDiagram,
        cockpit: Cockpit,
        holding: Holding,
        build: Callable[[Scene, DeviceBackend | None], HapticDiagram],
    ):
        """Begins with no tick.

        Args:
            haptic: Of the cockpit's scene, with the backend that is held.
            cockpit: Says what is to be otherwise.
            holding: Who holds the handle.
            build: Returns the diagram of a scene that somebody holds.
        """
        self._haptic = haptic
        self._cockpit = cockpit
        self._holding = holding
        self._build = build

    def run(
        self,
        duration_s: float | None,
        *,
        pace: TickClock,
        statistics: RunStatistics,
        energy: bool,
        on_begin: Callable[[HapticDiagram], None],
        on_tick: Callable[[Context], None],
    ) -> HapticDiagram:
        """Runs until the time is over, or Ctrl-C; see `CockpitRun.run`."""
        context: Context | None = None
        left_s = duration_s
        # Less than a tick is left of what round-off makes of whole ticks.
        while left_s is None or left_s > 0.5 * self._haptic.period_s:
            last: Context | None = None

            def end_tick(root: Context) -> bool:
                nonlocal last
                on_tick(root)
                if self._cockpit.end_tick(root):
                    last = root.Clone()
                return last is not None

            self._cockpit.begin(self._haptic, statistics, pace)
            on_begin(self._haptic)
            run(
                self._haptic,
                left_s,
                pace=pace,
                energy=energy,
                on_tick=end_tick,
                context=context,
                statistics=statistics,
            )
            change = self._cockpit.take_change()
            if last is None or change is None:
                break
            try:
                self._haptic, context = self._change(change, last)
            except KeyboardInterrupt:
                break
            # Building was no stall of the loop.
            pace.pause()
            if duration_s is not None:
                left_s = duration_s - statistics.ticks * self._haptic.period_s
        return self._haptic

    def _change(
        self, change: Change, last: Context
    ) -> tuple[HapticDiagram, Context | None]:
        """Returns what runs next, and from where.

        Args:
            change: What the segment ended for.
            last: Where it ended.
        """
        old, holding = self._haptic, self._holding
        backend = holding.backend
        X_WB = _find_device_base(old, last)
        if X_WB is not None:
            holding.note_place(X_WB)
        try:
            # What can be put anywhere is put where the scene starts.
            is_movable = backend is not None and backend.is_placed
            if change.handle != holding.name or (change.restarts and is_movable):
                X_WH = None if change.restarts else find_handle(old, last)
                holding.take(change.handle, X_WH)
            new = self._build(
                holding.place(self._cockpit.changes.scene), holding.backend
            )
        except UserError as error:
            if holding.backend is not backend:
                raise
            self._cockpit.refuse(str(error))
            return old, last
        return new, None if change.restarts else carry_on(old, last, new)


def _find_device_base(haptic: HapticDiagram, root: Context) -> RigidTransform | None:
    """Returns X_WB of a device's base; None where it is simulated.

    Args:
        haptic: What ran.
        root: Context of its diagram.
    """
    if haptic.backend is None:
        return None
    io = haptic.loop.device.GetSubsystemByName("device_io")
    reading = io.GetOutputPort("reading").Eval(io.GetMyContextFromRoot(root))
    return find_handle(haptic, root) @ vector_to_pose(reading.X_BH).inverse()
