"""Runs a scene with a page, in segments.

When a segment ends, the next diagram continues the run.
"""

from __future__ import annotations

import socket
import warnings
from collections.abc import Callable
from contextlib import ExitStack, closing
from functools import partial

from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context

from drake_haptics.cockpit.cockpit import Cockpit
from drake_haptics.cockpit.handle_holder import HandleHolder
from drake_haptics.cockpit.scene_changes import CouplingAdvice, SceneChanges
from drake_haptics.cockpit.steering import Change, PagePicture
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.run import RunError, run
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.simulation.transfer_state import (
    find_handle,
    release_diagram,
    transfer_context,
)
from drake_haptics.systems.output.haptic_picture import SHOWN_AT_FIRST
from drake_haptics.web.live_page import LivePage, look_from_the_front


class CockpitRun:
    """The page of a run, and the holder of its handle; it must be closed.

    Like all of Drake's Meshcat, it must be used from the thread that made the Meshcat.
    """

    def __init__(
        self,
        scene: Scene,
        meshcat: Meshcat,
        listener: socket.socket,
        *,
        name: str,
        device: str | None = None,
        locked: str = "",
        views: frozenset[str] = SHOWN_AT_FIRST,
    ):
        """Opens page and device; works without a browser.

        Args:
            scene: The scene to run.
            meshcat: The Meshcat that the page shows.
            listener: The page's port, from `open_page_port`.
            name: Name of the scene.
            device: Address of the device, as for `open_device`; None for the simulated
                one.
            locked: Reason why only the picture may be changed; empty if everything may
                be.
            views: Names of `PICTURE_VIEWS` that are shown at first.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: See `open_device`.
        """
        site = find_device_site(scene)
        p_WH = (site.X_WB @ site.X_BH).translation()
        self._meshcat = meshcat
        self._changes = SceneChanges(scene)
        with ExitStack() as stack:
            X_WC = look_from_the_front(p_WH, site.workspace_radius_m)
            self._page = LivePage(meshcat, X_WC, listener, is_aimed=True)
            stack.enter_context(closing(self._page))
            advice = CouplingAdvice(scene)
            self._holder = HandleHolder(
                scene, meshcat, device, has_hand=advice.has_hand
            )
            # Before the page, which shows the last force.
            stack.enter_context(closing(self._holder))
            self._cockpit = Cockpit(
                self._page,
                self._changes,
                self._holder,
                PagePicture(meshcat, views),
                advice,
                name=name,
                locked=locked,
            )
            self._steering = self._cockpit.steering
            self._closing = stack.pop_all()

    @property
    def url(self) -> str:
        """Address of the page."""
        return self._page.url

    @property
    def scene(self) -> Scene:
        """The scene with the changes of the page."""
        return self._changes.scene

    @property
    def backend(self) -> DeviceBackend | None:
        """The device in use; None for the scene's simulated device."""
        return self._holder.backend

    def run(
        self,
        haptic: HapticDiagram,
        duration_s: float | None,
        *,
        pace: RealTimePacer,
        statistics: RunStatistics,
        energy: bool,
        on_begin: Callable[[HapticDiagram], None],
        on_tick: Callable[[Context], None],
    ) -> HapticDiagram:
        """Runs a scene, with the changes that are made on the page.

        Args:
            haptic: Diagram of the scene, with `backend`.
            duration_s: Simulated time, s; None runs until Ctrl-C.
            pace: Pacer that waits for each tick.
            statistics: Statistics of the whole run.
            energy: Whether to account for energy, in a run that is locked.
            on_begin: Function that is called with each diagram before it runs.
            on_tick: Function that is called after every tick with the diagram's
                context.

        Returns:
            The diagram that ran last.

        Raises:
            RunError: The run failed; see `simulation.run`.
        """
        self._haptic, self._is_restart = haptic, True
        run_some = partial(run, pace=pace, energy=energy, statistics=statistics)
        left_s, context = duration_s, None
        try:
            # Round-off may leave less than a tick.
            while left_s is None or left_s > 0.5 * self._haptic.period_s:
                self._cockpit.begin(
                    self._haptic, statistics, pace, is_restart=self._is_restart
                )
                on_begin(self._haptic)
                change, last = self._run_one(run_some, left_s, context, on_tick)
                if change is None:
                    break
                old = self._haptic
                self._haptic, context = self._change(change, last)
                if self._haptic is not old:
                    release_diagram(old)
                # Building is not a stall of the loop.
                pace.pause()
                if duration_s is not None:
                    left_s = duration_s - statistics.ticks * self._haptic.period_s
        except KeyboardInterrupt:
            pass
        except RunError as error:
            self._holder.close()
            self._page.close(f"The run {error}.")
            raise
        return self._haptic

    def close(self) -> None:
        """Releases the handle at zero force, and closes the page."""
        self._closing.close()

    def _run_one(
        self,
        run_some: Callable[..., object],
        left_s: float | None,
        context: Context | None,
        on_tick: Callable[[Context], None],
    ) -> tuple[Change | None, Context | None]:
        """Runs a segment.

        Returns:
            The change that ended it, None if the run is over; and the context at its
            end, None if it failed.
        """
        last: Context | None = None

        def end_tick(root: Context) -> bool:
            nonlocal last
            on_tick(root)
            if self._cockpit.end_tick(root):
                last = root.Clone()
            return last is not None

        try:
            run_some(self._haptic, left_s, on_tick=end_tick, context=context)
        except RunError as error:
            if not self._steering.fall_back(str(error)):
                raise
            return Change(self._holder.name, restarts=True), None
        return (None if last is None else self._steering.take_change()), last

    def _change(
        self, change: Change, last: Context | None
    ) -> tuple[HapticDiagram, Context]:
        """Returns the next diagram, and the context from which it starts.

        Args:
            change: The change that ended the segment.
            last: Context at its end; None if it failed and restarts.
        """
        old, holder = self._haptic, self._holder
        backend = holder.backend
        # A device that reports its pose begins there again.
        is_restart = change.restarts and backend is not None and backend.is_placed
        # A hand on a device may press, so that a tool placed at its handle would kick.
        is_kept = change.handle == holder.name and not is_restart
        is_felt = is_kept and holder.is_felt
        goes_on = last is not None and (is_felt or not change.restarts)
        X_WH = find_handle(old, last) if goes_on else None
        self._is_restart = not goes_on
        try:
            if change.handle != holder.name or is_restart:
                holder.take(change.handle, X_WH)
            new = self._build(old, X_WH)
        except HapticsError as error:
            if holder.backend is not backend:
                raise
            self._steering.refuse(str(error))
            return old, last
        if holder.taken is not None:
            # Effects change at once, but the force on the hand must not.
            holder.taken.hand_over()
        if goes_on:
            context = transfer_context(old, last, new)
            if change.restarts:
                context.SetTime(0.0)
        else:
            context = new.diagram.CreateDefaultContext()
            new.diagram.ExecuteInitializationEvents(context)
        self._steering.carry_values(new, context)
        return new, context

    def _build(self, old: HapticDiagram, X_WH: RigidTransform | None) -> HapticDiagram:
        """Returns the diagram of the present scene with its present holder.

        Args:
            old: The diagram that ran.
            X_WH: Pose at which the handle continues; None if the scene begins.
        """
        with warnings.catch_warnings():
            # The page shows them.
            warnings.simplefilter("ignore", SceneWarning)
            return BuildHapticDiagram(
                self._changes.scene,
                device=self._holder.backend,
                meshcat=self._meshcat if old.visualizer is not None else None,
                reuse=old,
                X_WH=X_WH,
            )
