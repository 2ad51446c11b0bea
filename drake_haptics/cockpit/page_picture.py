"""What the page shows of a run: views and camera."""

from __future__ import annotations

from typing import Any

from pydrake.geometry import Meshcat

from drake_haptics.builder import HapticDiagram
from drake_haptics.stage import aim_camera
from drake_haptics.systems.picture_views import PICTURE_VIEWS, check_view


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
        self._haptic: HapticDiagram | None = None
        self.views = {view: view in views for view in PICTURE_VIEWS}

    def begin(self, haptic: HapticDiagram) -> None:
        """Shows of a diagram what was shown of the one before."""
        self._haptic = haptic
        if haptic.visualizer is not None:
            for view, visible in self.views.items():
                haptic.visualizer.Show(view, visible)

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
                if self._haptic is not None:
                    aim_camera(self._meshcat, self._haptic, request["to"], within)
            case _:
                return False
        return True

    def _show(self, view: str, visible: bool) -> None:
        """Shows or hides a view."""
        check_view(view)
        self.views[view] = visible
        if self._haptic is not None and self._haptic.visualizer is not None:
            self._haptic.visualizer.Show(view, visible)
