"""The cockpit's end in the loop: shows each tick, and does what the page asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from time import monotonic
from typing import Any

from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context

from drake_haptics.builder import HapticDiagram
from drake_haptics.cockpit.coupling_advice import CouplingAdvice
from drake_haptics.cockpit.greeting import make_greeting
from drake_haptics.cockpit.holding import DEVICE, HAND, Holding
from drake_haptics.cockpit.live_page import LivePage, Outlook
from drake_haptics.cockpit.page_picture import PagePicture
from drake_haptics.cockpit.page_request import REFUSED
from drake_haptics.cockpit.scene_changes import (
    SCENE_VERBS,
    ChangeError,
    SceneChanges,
)
from drake_haptics.cockpit.telemetry import SIMULATED
from drake_haptics.errors import UserError
from drake_haptics.live_keys import LiveKey
from drake_haptics.live_scene import is_live_change, write_live_values
from drake_haptics.run_statistics import RunStatistics
from drake_haptics.systems.picture_views import SHOWN_AT_FIRST
from drake_haptics.tick_clock import TickClock

# Pages are told of changes no oftener: a slider that is dragged makes one per frame.
_TELL_PERIOD_S = 0.1
# A slider that needs another diagram builds it when it has rested for so long.
_REST_S = 0.25
_AT_ONCE = -math.inf


@dataclass(frozen=True)
class Change:
    """What a segment of a run ended for.

    Attributes:
        handle: Who is to hold the handle from now on.
        restarts: Whether the scene begins anew.
    """

    handle: str
    restarts: bool


class Cockpit:
    """Shows a run and steers it, as its page wants.

    A run is a sequence of segments, each of one diagram. What can be written into a
    Context is, between two ticks; what cannot ends the segment.

    Attributes:
        changes: The scene as people have changed it.
    """

    def __init__(
        self,
        page: LivePage,
        meshcat: Meshcat,
        changes: SceneChanges,
        holding: Holding,
        advice: CouplingAdvice,
        *,
        name: str,
        locked: str = "",
        views: frozenset[str] = SHOWN_AT_FIRST,
    ):
        """Greets the page.

        Args:
            page: To be closed by the caller.
            meshcat: In the page.
            changes: The scene.
            holding: Who holds the handle.
            advice: Of the scene.
            name: Of the scene.
            locked: Why nothing but the picture may be changed; empty if it may.
            views: Of `PICTURE_VIEWS`, what is shown at first.
        """
        self.changes = changes
        self._page = page
        self._holding = holding
        self._name = name
        self._locked = locked
        self._picture = PagePicture(meshcat, views)
        self._running = changes.scene
        self._advice = advice
        self._error = ""
        self._change: Change | None = None
        # When to tell the page how things are, and when to end the segment.
        self._tell_s = self._end_s = math.inf
        self._told_s = self._failed_s = -math.inf
        self._root: Context | None = None
        self._greeted: tuple[LiveKey, ...] = ()

    def begin(
        self, haptic: HapticDiagram, statistics: RunStatistics, pace: TickClock | None
    ) -> None:
        """Begins a segment, of a diagram of the scene as it is now.

        Args:
            haptic: What runs.
            statistics: Of the run.
            pace: What paces it, if it is paced.
        """
        self._haptic, self._statistics, self._pace = haptic, statistics, pace
        self._root = None
        self._change, self._end_s = None, math.inf
        self._picture.begin(haptic)
        self._running = self.changes.scene
        # Other effects draw, and are told, other things.
        self._greeted = ()
        self._tell()

    def end_tick(self, context: Context) -> bool:
        """Notes a tick, talks with the page if it is time; to be called after a tick.

        Args:
            context: The diagram's.

        Returns:
            Whether the segment is to end: `take_change` says for what.
        """
        pace = self._pace
        late_s = 0.0 if pace is None else pace.last_late_s
        self._page.note(context.get_time(), self._statistics.latest, late_s)
        self._root = context
        now_s = monotonic()
        asked = self._page.act(now_s, self._look_out)
        if asked:
            self._obey(asked, now_s)
        if now_s >= self._tell_s:
            self._tell()
        return now_s >= self._end_s

    def take_change(self) -> Change | None:
        """Returns what the segment ended for; None if it was for something else."""
        change, self._change = self._change, None
        return change

    def refuse(self, why: str) -> None:
        """Takes back what could not be built, and tells the page why."""
        self.changes.restore(self._running)
        self._error = why

    def fall_back(self, why: str) -> bool:
        """Takes all changes back, with which a run has failed.

        Args:
            why: It has; the page is told.

        Returns:
            Whether there were any, of a run that nobody feels: else it is over.
        """
        changes = self.changes
        if changes.scene is changes.file or self._holding.name == DEVICE:
            return False
        changes.restore(changes.file)
        self._error = f"It was too much: {why}. The scene begins anew, as in its file."
        return True

    def _greet(self) -> None:
        """Tells the page what there is to see and to change."""
        greeting = make_greeting(
            self.changes,
            name=self._name,
            meshcat_url=self._page.meshcat_url,
            handles=self._holding.names,
            locked=self._locked,
        )
        self._page.tell("hello", greeting)

    def _tell(self) -> None:
        """Tells the page how things are, and if that is new what can be set."""
        self._told_s, self._tell_s = monotonic(), math.inf
        if self._greeted != (keys := self.changes.list_keys()):
            self._greet()
            self._greeted = keys
        scene = self.changes.scene
        state = {
            **self.changes.describe(),
            "handle": self._holding.name,
            "views": self._picture.views,
            "warnings": [f"coupling.{text}" for text in self._advice.check(scene)],
            "error": self._error,
        }
        self._page.tell("state", state)

    def _look_out(self) -> Outlook:
        """Returns what else a frame shows."""
        assert self._root is not None
        loop, backend = self._haptic.loop, self._holding.backend
        reading = None if backend is None else backend.read()
        handle = loop.device.get_handle_pose_output_port()
        X_WH = handle.Eval(loop.device.GetMyContextFromRoot(self._root))
        shed = 0
        if loop.load_shedding is not None:
            relief = loop.load_shedding.GetMyContextFromRoot(self._root)
            shed = math.ceil(relief.get_discrete_state_vector().value()[0])
        return Outlook(
            gate=SIMULATED if reading is None else int(reading.gate),
            p_WH=X_WH[4:].tolist(),
            shed=shed,
            skipped=0 if self._pace is None else self._pace.skipped,
        )

    def _obey(self, asked: list[dict[str, Any]], now_s: float) -> None:
        """Does what pages have asked for."""
        before = self.changes.scene
        for request in asked:
            if self._point(request):
                continue
            try:
                if not (self._picture.obey(request) or self._steer(request)):
                    continue
                # What has not been told yet is told first.
                if self._told_s > self._failed_s:
                    self._error = ""
            except (UserError, ValueError) as error:
                self._error, self._failed_s = str(error), now_s
            self._tell_s = max(now_s, self._told_s + _TELL_PERIOD_S)
        if self.changes.scene is not before:
            try:
                self._apply(now_s)
            except ValueError as error:
                self.refuse(str(error))

    def _point(self, request: dict[str, Any]) -> bool:
        """Moves the handle, if that is what is asked; returns whether it is."""
        pointer = self._holding.pointer
        if pointer is None:
            return False
        if REFUSED in request:
            pointer.note_refused()
        return pointer.obey(request, self._page.camera.X_WC)

    def _steer(self, request: dict[str, Any]) -> bool:
        """Changes the run, if that is what is asked; returns whether it is.

        Raises:
            ChangeError: It cannot be.
        """
        verb = request.get("do")
        if verb not in ("handle", "restart", *SCENE_VERBS):
            return False
        if self._locked:
            raise ChangeError(self._locked)
        if verb in SCENE_VERBS:
            self.changes.obey(request)
            return True
        handle = request.get("to")
        if handle is not None and handle not in self._holding.names:
            raise ChangeError(f"There is nobody called {handle!r} to hold the handle.")
        # A real hand takes the tool with it; the simulated one begins its path.
        self._end(_AT_ONCE, handle, verb == "restart" or handle in (HAND, DEVICE))
        return True

    def _apply(self, now_s: float) -> None:
        """Makes the loop run the scene as it is now."""
        scene = self.changes.scene
        if not is_live_change(self._haptic.scene, scene):
            self._end(now_s + _REST_S)
            return
        write_live_values(self._haptic, self._root, scene)
        self._running = self.changes.scene

    def _end(
        self, end_s: float, handle: str | None = None, restarts: bool = False
    ) -> None:
        """Ends the segment at a time, for this and for what it is to end for already.

        Args:
            end_s: When, if it is not to end at once.
            handle: Who is to hold the handle, if somebody else is.
            restarts: Whether the scene is to begin anew.
        """
        if self._change is not None:
            handle = handle or self._change.handle
            restarts = restarts or self._change.restarts
        self._change = Change(handle or self._holding.name, restarts)
        if self._end_s != _AT_ONCE:
            self._end_s = end_s
