"""Makes axes for plots."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def find_axes(axes: Axes | None, size: tuple[float, float] | None = None) -> Axes:
    """Returns axes to draw in.

    Args:
        axes: Axes to return; None makes a new figure.
        size: Width and height of the figure, inches. Defaults to Matplotlib's.
    """
    if axes is not None:
        return axes
    from matplotlib import pyplot

    return pyplot.figure(figsize=size).add_subplot()
