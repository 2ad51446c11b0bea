"""Runs a scene with a page, from the opening of its device to its last tick.

A run consists of segments: where one ends, the next diagram goes on.
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
from drake_haptics.cockpit.holding import Holding
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
    """The page of a run, and the holder of its handle; to be closed.

    As all of Drake's Meshcat, it is to be used from the thread that made the Meshcat.
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
            listener: The page's port, of `open_page_port`.
            name: Name of the scene.
            device: Address of the device that is held, as for `open_device`; None for
                the simulated one.
            locked: Reason why only the picture may be changed; empty if all may be.
            views: The members of `PICTURE_VIEWS` that are shown at first.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: See `open_device`.
        """
        site = find_device_site(scene)
        p_WH = (site.X_WB @ site.X_BH).translation()
        self._meshcat = meshcat
        self._changes = SceneChanges(scene)
        with ExitStack() as stack:
            X_WC = look_from_the_front(p_WH, site.workspace_radius_m)
            self._page = LivePage(meshcat, X_WC, listener)
            stack.enter_context(closing(self._page))
            advice = CouplingAdvice(scene)
            self._holding = Holding(scene, meshcat, device, has_hand=advice.has_hand)
            # Before the page, which tells of the last force.
            stack.enter_context(closing(self._holding))
            self._cockpit = Cockpit(
                self._page,
                self._changes,
                self._holding,
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
        """The scene as it is now, with what the page has changed."""
        return self._changes.scene

    @property
    def backend(self) -> DeviceBackend | None:
        """The device that is held; None for the scene's simulated device."""
        return self._holding.backend

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
            duration_s: Simulated time, s; until Ctrl-C where None.
            pace: Waits for each tick.
            statistics: Statistics of the whole run.
            energy: Whether to book energy, in a run that is locked.
            on_begin: Called with each diagram before it runs.
            on_tick: Called after every tick with the diagram's context.

        Returns:
            The diagram that ran last.

        Raises:
            RunError: The run failed, see `simulation.run`.
        """
        self._haptic, self._is_restart = haptic, True
        run_some = partial(run, pace=pace, energy=energy, statistics=statistics)
        left_s, context = duration_s, None
        try:
            # Round-off leaves less than a tick after the last whole one.
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
                # Building was no stall of the loop.
                pace.pause()
                if duration_s is not None:
                    left_s = duration_s - statistics.ticks * self._haptic.period_s
        except KeyboardInterrupt:
            pass
        except RunError as error:
            self._holding.close()
            self._page.close(f"The run {error}.")
            raise
        return self._haptic

    def close(self) -> None:
        """Lets go of the handle at zero force, and ends the page."""
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
            The change for which it ended, None if the run is over; and the context at
            its end, None if it failed.
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
            return Change(self._holding.name, restarts=True), None
        return (None if last is None else self._steering.take_change()), last

    def _change(
        self, change: Change, last: Context | None
    ) -> tuple[HapticDiagram, Context]:
        """Returns the next diagram, and the context that it starts from.

        Args:
            change: The change for which the segment ended.
            last: Context at its end; None where it failed, and restarts.
        """
        old, holding = self._haptic, self._holding
        backend = holding.backend
        # A device that says itself where it is begins there again.
        is_restart = change.restarts and backend is not None and backend.is_placed
        # A hand on a device may press: a tool put into its handle would kick.
        is_kept = change.handle == holding.name and not is_restart
        is_felt = is_kept and holding.is_felt
        goes_on = last is not None and (is_felt or not change.restarts)
        X_WH = find_handle(old, last) if goes_on else None
        self._is_restart = not goes_on
        try:
            if change.handle != holding.name or is_restart:
                holding.take(change.handle, X_WH)
            new = self._build(old, X_WH)
        except HapticsError as error:
            if holding.backend is not backend:
                raise
            self._steering.refuse(str(error))
            return old, last
        if holding.taken is not None:
            # Effects come and go at once, but the force that is felt does not.
            holding.taken.hand_over()
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
        """Returns the diagram of the scene as it is now, held as it is now.

        Args:
            old: The diagram that ran.
            X_WH: Pose at which the handle goes on; None where the scene begins.
        """
        with warnings.catch_warnings():
            # The page tells it.
            warnings.simplefilter("ignore", SceneWarning)
            return BuildHapticDiagram(
                self._changes.scene,
                device=self._holding.backend,
                meshcat=self._meshcat if old.visualizer is not None else None,
                reuse=old,
                X_WH=X_WH,
            )
