"""The page of the mouse device, filled in."""

from __future__ import annotations

import json
from importlib.resources import files
from string import Template

from drake_haptics import colors

# Names of colours in the page's style sheet.
_COLORS = {
    "handle": (*colors.HANDLE_GHOST[:3], 1.0),
    "force": colors.COUPLING_LINE,
    "torque": colors.SLIDING_CONTACT,
    "active": colors.NEAR_CONTACT,
    "fault": colors.PENETRATING_CONTACT,
    "bottom": colors.BACKGROUND_BOTTOM,
}


def make_mouse_page(meshcat_url: str, max_force_N: float, max_torque_Nm: float) -> str:
    """Returns the page as HTML.

    Args:
        meshcat_url: Address of the Meshcat that it shows.
        max_force_N: Force of a full bar, N.
        max_torque_Nm: Torque of a full bar, N·m.
    """
    page = files("drake_haptics.device").joinpath("mouse_page.html")
    settings = {
        # The Meshcat then tells where the camera of this page is.
        "meshcat": f"{meshcat_url}/?tracked_camera=on",
        "maxForce": max_force_N,
        "maxTorque": max_torque_Nm,
    }
    return Template(page.read_text(encoding="utf-8")).substitute(
        settings=json.dumps(settings).replace("<", "\\u003c"),
        colors="; ".join(f"--{name}: {_css(c)}" for name, c in _COLORS.items()),
    )


def _css(color: colors.Color) -> str:
    """Returns a colour as CSS writes it."""
    red, green, blue = (round(255 * part) for part in color[:3])
    return f"rgb({red} {green} {blue} / {color[3]:g})"
