"""What the page shows of a run: views and camera."""

from __future__ import annotations

from typing import Any

from pydrake.geometry import Meshcat

from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.systems.output.haptic_picture import PICTURE_VIEWS, check_view
from drake_haptics.visualization.meshcat import aim_camera, find_framed_points

# Of force and torque on the hand, in the picture's scene tree.
_FELT = ("/haptics/force", "/haptics/torque")
_UNFELT_OPACITY = 0.25


class PagePicture:
    """Keeps what is shown, whatever diagram is drawn.

    Attributes:
        views: Whether each of `PICTURE_VIEWS` is shown.
    """

    def __init__(self, meshcat: Meshcat, views: frozenset[str]):
        """Begins without a diagram.

        Args:
            meshcat: Whose camera it is.
            views: What is shown at first.
        """
        self._meshcat = meshcat
        self.views = {view: view in views for view in PICTURE_VIEWS}
        self._is_felt = True

    def begin(self, haptic: HapticDiagram) -> None:
        """Shows of a diagram what was shown of the one before."""
        self._visualizer = haptic.visualizer
        # Of many objects it would be long for a tick.
        self._p_WP = find_framed_points(haptic)
        # What is drawn for the first time is not faded.
        self._is_felt = True
        if self._visualizer is not None:
            for view, visible in self.views.items():
                self._visualizer.Show(view, visible)

    def mark_felt(self, is_felt: bool) -> None:
        """Fades the arrows of a wrench that is asked for and not shown."""
        if is_felt == self._is_felt:
            return
        self._is_felt = is_felt
        opacity = 1.0 if is_felt else _UNFELT_OPACITY
        for path in _FELT:
            self._meshcat.SetProperty(path, "modulated_opacity", opacity)

    def obey(self, request: dict[str, Any]) -> bool:
        """Does what a page asks for, if that is a matter of the picture.

        Args:
            request: As `read_page_request` returns it.

        Returns:
            Whether it was.

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
        """Shows or hides a view."""
        check_view(view)
        self.views[view] = visible
        if self._visualizer is not None:
            self._visualizer.Show(view, visible)
