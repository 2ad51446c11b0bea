"""A run with a page, from the opening of its device to its last tick."""

from __future__ import annotations

import socket
from collections.abc import Callable
from contextlib import ExitStack, closing

from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context

from drake_haptics.cockpit.cockpit import Cockpit
from drake_haptics.cockpit.coupling_advice import CouplingAdvice
from drake_haptics.cockpit.holding import Holding
from drake_haptics.cockpit.page_picture import PagePicture
from drake_haptics.cockpit.scene_changes import SceneChanges
from drake_haptics.cockpit.segments import Segments
from drake_haptics.common.real_time import TickClock
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import RunError
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.systems.output.haptic_picture import SHOWN_AT_FIRST
from drake_haptics.web.camera import look_from_the_front
from drake_haptics.web.live_page import LivePage

# Until a page tells, the camera is this many radii in front of the workspace: at -y.
_FIRST_DISTANCE = 4.0


class CockpitRun:
    """The page of a run, and who holds its handle; to be closed.

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
        """Opens page and device; nobody need look at the page.

        Args:
            scene: What is to run.
            meshcat: In the page.
            listener: The page's port, of `open_page_port`.
            name: Of the scene.
            device: Address of what is held, as `open_device`; None for the simulated
                one.
            locked: Why nothing but the picture may be changed; empty if it may.
            views: Of `PICTURE_VIEWS`, what is shown at first.

        Raises:
            DeviceError, SceneError, TickLogError, OSError: As `open_device`.
        """
        site = find_device_site(scene)
        p_WH = (site.X_WB @ site.X_BH).translation()
        distance_m = _FIRST_DISTANCE * site.workspace_radius_m
        self._meshcat = meshcat
        self._changes = SceneChanges(scene)
        with ExitStack() as stack:
            self._page = LivePage(
                meshcat, look_from_the_front(p_WH, distance_m), listener
            )
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
        """What is held; None for the scene's simulated device."""
        return self._holding.backend

    def run(
        self,
        haptic: HapticDiagram,
        duration_s: float | None,
        *,
        pace: TickClock,
        statistics: RunStatistics,
        energy: bool,
        on_begin: Callable[[HapticDiagram], None],
        on_tick: Callable[[Context], None],
    ) -> HapticDiagram:
        """Runs a scene, and what becomes of it on the page.

        Args:
            haptic: Of the scene, with `backend`.
            duration_s: Simulated time, s; until Ctrl-C where None.
            pace: Waits for each tick.
            statistics: Of all that runs.
            energy: Whether to book energy: of a run that is locked.
            on_begin: Called with each diagram before it runs.
            on_tick: Called after every tick with the diagram's context.

        Returns:
            What ran last.

        Raises:
            RunError: As `simulation.run`.
        """
        segments = Segments(haptic, self._cockpit, self._holding, self._meshcat)
        try:
            return segments.run(
                duration_s,
                pace=pace,
                statistics=statistics,
                energy=energy,
                on_begin=on_begin,
                on_tick=on_tick,
            )
        except RunError as error:
            self._holding.close()
            self._page.close(f"The run {error}.")
            raise

    def close(self) -> None:
        """Lets go of the handle at zero force, and ends the page."""
        self._closing.close()
