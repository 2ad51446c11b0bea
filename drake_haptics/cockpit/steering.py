"""Executes requests of pages, at once or by a new segment of the run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context

from drake_haptics.cockpit.handle_holder import DEVICE, HAND, HandleHolder
from drake_haptics.cockpit.scene_changes import SCENE_VERBS, ChangeError, SceneChanges
from drake_haptics.common.errors import HapticsError
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.simulation.live_values import (
    LiveValueRamp,
    is_live_change,
    put_live_values,
)
from drake_haptics.systems.output.haptic_picture import PICTURE_VIEWS, check_view
from drake_haptics.visualization.meshcat import aim_camera, find_framed_points
from drake_haptics.web.messages import REFUSED

# Arrows of force and torque on the hand, in the picture's scene tree.
_FELT = ("/haptics/force", "/haptics/torque")
_UNFELT_OPACITY = 0.25


class PagePicture:
    """Keeps the views from one diagram to the next.

    Attributes:
        views: Whether each of `PICTURE_VIEWS` is shown.
    """

    def __init__(self, meshcat: Meshcat, views: frozenset[str]):
        """Begins without a diagram."""
        self._meshcat = meshcat
        self.views = {view: view in views for view in PICTURE_VIEWS}
        self._is_felt = True

    def begin(self, haptic: HapticDiagram) -> None:
        """Shows the same views for a new diagram."""
        self._visualizer = haptic.visualizer
        # With many objects this takes too long for a tick.
        self._p_WP = find_framed_points(haptic)
        # New arrows are not faded.
        self._is_felt = True
        if self._visualizer is not None:
            for view, visible in self.views.items():
                self._visualizer.Show(view, visible)

    def mark_felt(self, is_felt: bool) -> None:
        """Fades the arrows of a wrench that is commanded but not shown."""
        if is_felt == self._is_felt:
            return
        self._is_felt = is_felt
        opacity = 1.0 if is_felt else _UNFELT_OPACITY
        for path in _FELT:
            self._meshcat.SetProperty(path, "modulated_opacity", opacity)

    def obey(self, request: dict[str, Any]) -> bool:
        """Executes a page's request, if it concerns the picture.

        Returns:
            Whether it did.

        Raises:
            ValueError: There is no such view or camera.
        """
        match request.get("do"):
            case "view":
                self._show(request["name"], request["on"])
            case "camera":
                within = request.get("within", 1.0)
                aim_camera(self._meshcat, self._p_WP, request["to"], within)
            case _:
                return False
        return True

    def _show(self, view: str, visible: bool) -> None:
        check_view(view)
        self.views[view] = visible
        if self._visualizer is not None:
            self._visualizer.Show(view, visible)


# Time for which a slider must rest before a new diagram is built, s.
_REST_S = 0.25
_AT_ONCE = -math.inf


@dataclass(frozen=True)
class Change:
    """The next holder of the handle, and whether the scene begins again."""

    handle: str
    restarts: bool


class Steering:
    """Controls a run from its page.

    A run is a sequence of segments with one diagram each. A change that can be written
    into a Context is written between ticks; any other change ends the segment. A change
    that is not possible is answered with a sentence.

    Values change gradually, so that the hand feels no step.

    Attributes:
        changes: The changes of the scene.
        answered: Number of the last request with one that was executed or refused.
    """

    def __init__(
        self,
        changes: SceneChanges,
        holder: HandleHolder,
        picture: PagePicture,
        locked: str = "",
    ):
        """Begins without a diagram."""
        self.changes = changes
        self.answered = 0
        self._end_s = math.inf
        self._error, self._is_error_told = "", True
        self._holder = holder
        self._picture = picture
        self._locked = locked
        self._running = changes.scene
        self._change: Change | None = None
        self._glide = self._make_glide()

    def begin(self, haptic: HapticDiagram) -> None:
        """Begins a segment with a diagram of the present scene."""
        self._haptic = haptic
        self._running = self.changes.scene
        self._change, self._end_s = None, math.inf
        self._glide.aim(self._running)
        self._picture.begin(haptic)

    def carry_values(self, haptic: HapticDiagram, root: Context) -> None:
        """Writes values that still change into the context of a new diagram."""
        self._running = haptic.scene
        self._glide.aim(haptic.scene)
        self._write(haptic, root)

    def end_tick(self, root: Context, now_s: float) -> bool:
        """Advances values that change; to be called after each tick.

        Returns:
            Whether the segment must end; `take_change` has the reason.
        """
        if self._glide.is_moving:
            self._glide.advance()
            self._write(self._haptic, root)
        return now_s >= self._end_s

    def take_change(self) -> Change | None:
        """Returns the change that ended the segment; None if something else did."""
        change, self._change = self._change, None
        return change

    def refuse(self, why: str) -> None:
        """Undoes changes that could not be built."""
        self.changes.restore(self._running)
        self._fail(why)

    def fall_back(self, why: str) -> bool:
        """Undoes all changes, after a run has failed with them.

        Returns:
            Whether there were any changes; False ends the run, also with a real device.
        """
        changes = self.changes
        if changes.scene is changes.file or self._holder.name == DEVICE:
            return False
        changes.restore(changes.file)
        self._glide = self._make_glide()
        self._fail(f"The run failed: {why}. The scene starts again, as in its file.")
        return True

    def tell_error(self) -> str:
        """Returns why the last request failed; empty if it succeeded.

        An error that was not yet sent remains when a later request succeeds.
        """
        self._is_error_told = True
        return self._error

    def obey(
        self,
        asked: Sequence[dict[str, Any]],
        root: Context,
        X_WC: RigidTransform,
        now_s: float,
    ) -> bool:
        """Executes the requests of pages.

        Returns:
            Whether there is anything new to send.
        """
        before, is_new = self.changes.scene, False
        for request in asked:
            if self._point(request, X_WC):
                continue
            try:
                if not (self._picture.obey(request) or self._steer(request)):
                    continue
                if self._is_error_told:
                    self._error = ""
            except (HapticsError, ValueError) as error:
                self._fail(str(error))
            is_new = True
            self.answered = request.get("number", self.answered)
        if self.changes.scene is not before:
            self._apply(root, now_s)
        return is_new

    def _point(self, request: dict[str, Any], X_WC: RigidTransform) -> bool:
        """Moves the handle, if that is the request; returns whether it is."""
        pointer = self._holder.pointer
        if pointer is None:
            return False
        if REFUSED in request:
            pointer.note_refused()
        return pointer.obey(request, X_WC)

    def _steer(self, request: dict[str, Any]) -> bool:
        """Changes the run, if that is the request; returns whether it is.

        Raises:
            ChangeError: The change is not possible.
        """
        verb = request.get("do")
        if verb == "resume" and (taken := self._holder.taken) is not None:
            taken.resume()
            return True
        if verb not in ("handle", "restart", *SCENE_VERBS):
            return False
        if self._locked:
            raise ChangeError(self._locked)
        if verb in SCENE_VERBS:
            self.changes.obey(request)
            return True
        handle = request.get("to")
        if handle is not None and handle not in self._holder.names:
            raise ChangeError(f"There is no holder called {handle!r}.")
        # The simulated hand begins its path; others take the handle where it is.
        self._end(_AT_ONCE, handle, verb == "restart" or handle == HAND)
        return True

    def _fail(self, why: str) -> None:
        """Keeps an error to send to the page."""
        self._error, self._is_error_told = why, False

    def _apply(self, root: Context, now_s: float) -> None:
        """Makes the loop run the present scene."""
        scene = self.changes.scene
        if is_live_change(self._haptic.scene, scene):
            self._running = scene
            self._glide.aim(scene)
            # The clustering changes at once.
            self._write(self._haptic, root)
        else:
            self._end(now_s + _REST_S)

    def _write(self, haptic: HapticDiagram, root: Context) -> None:
        """Writes the present values."""
        put_live_values(haptic, root, self._glide.apply(self._running))

    def _make_glide(self) -> LiveValueRamp:
        """Returns a ramp that has arrived."""
        return LiveValueRamp(1.0 / self.changes.file.device.rate_hz)

    def _end(
        self, end_s: float, handle: str | None = None, restarts: bool = False
    ) -> None:
        """Ends the segment at a time or earlier, for this change and those pending."""
        if self._change is not None:
            handle = handle or self._change.handle
            restarts = restarts or self._change.restarts
        self._change = Change(handle or self._holder.name, restarts)
        if self._end_s != _AT_ONCE:
            self._end_s = end_s
