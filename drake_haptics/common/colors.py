"""Defines the colors of viewers and plots: (red, green, blue, alpha) in [0, 1]."""

from __future__ import annotations

import colorsys

Color = tuple[float, float, float, float]

NEAR_CONTACT: Color = (0.16, 0.70, 0.32, 1.0)
PENETRATING_CONTACT: Color = (0.86, 0.16, 0.16, 1.0)
STICKING_CONTACT: Color = (0.36, 0.24, 0.62, 1.0)
SLIDING_CONTACT: Color = (0.72, 0.42, 0.86, 1.0)
TOOL: Color = (0.93, 0.62, 0.22, 1.0)
ENVIRONMENT: Color = (0.62, 0.68, 0.76, 1.0)
HANDLE_GHOST: Color = (0.25, 0.47, 0.85, 0.35)
COUPLING_LINE: Color = (0.98, 0.82, 0.20, 1.0)
TORQUE: Color = (0.05, 0.60, 0.66, 1.0)
VIRTUAL_FACET: Color = (0.25, 0.25, 0.28, 0.30)
BACKGROUND_TOP: Color = (0.97, 0.97, 0.98, 1.0)
BACKGROUND_BOTTOM: Color = (0.86, 0.88, 0.91, 1.0)

# Lines and letters on white: the force's and the torque's.
FORCE_INK: Color = (0.62, 0.40, 0.0, 1.0)
TORQUE_INK: Color = (0.0, 0.42, 0.47, 1.0)

# Distinct colors for lines and letters on white, in an order that repeats.
INKS: tuple[Color, ...] = (
    FORCE_INK,
    STICKING_CONTACT,
    TORQUE_INK,
    (0.70, 0.12, 0.14, 1.0),
    (0.12, 0.46, 0.20, 1.0),
    (0.66, 0.20, 0.55, 1.0),
)

# Plots of stability, with one meaning per color; the scene's own values are black.
STABLE: Color = NEAR_CONTACT
UNSTABLE: Color = PENETRATING_CONTACT
EIGENVALUE: Color = (*HANDLE_GHOST[:3], 1.0)
SIMULATION: Color = TOOL
ONE_AXIS: Color = ENVIRONMENT
FORMULA: Color = (0.30, 0.36, 0.46, 1.0)
PASSIVITY: Color = TORQUE_INK

# Plots of accuracy: the front with its knees, and other models of contact.
FRONT: Color = EIGENVALUE
OTHER_MODEL: Color = FORMULA

_LEGEND = (
    (TOOL, "tool"),
    (ENVIRONMENT, "what it meets"),
    (HANDLE_GHOST, "where the handle wants the tool"),
    (COUPLING_LINE, "coupling, force on the hand"),
    (TORQUE, "torque on the hand"),
    (NEAR_CONTACT, "near contact and its force"),
    (PENETRATING_CONTACT, "penetrating contact and its force"),
)
_FRICTION_LEGEND = (
    (STICKING_CONTACT, "friction that sticks"),
    (SLIDING_CONTACT, "friction that slides"),
)

_GOLDEN_RATIO = (1 + 5**0.5) / 2


def piece_color(index: int) -> Color:
    """Returns the color of a convex piece.

    Hues advance by the golden ratio, so that neighbors in the order differ as much as
    possible for any number of pieces; saturation and value alternate with periods 3 and
    4 to distinguish similar hues.
    """
    hue = (index / _GOLDEN_RATIO) % 1.0
    saturation = (0.55, 0.70, 0.45)[index % 3]
    value = (0.92, 0.80, 0.98, 0.70)[index % 4]
    red, green, blue = colorsys.hsv_to_rgb(hue, saturation, value)
    return (red, green, blue, 1.0)


def write_css(color: Color) -> str:
    """Returns a color in CSS."""
    red, green, blue = (round(255 * part) for part in color[:3])
    return f"rgb({red} {green} {blue} / {color[3]:g})"


def make_legend(has_friction: bool) -> list[dict[str, str]]:
    """Returns the legend of a loop's picture.

    Returns:
        The `color` in CSS and the `label` of each entry.
    """
    rows = _LEGEND + (_FRICTION_LEGEND if has_friction else ())
    return [{"color": write_css(color), "label": label} for color, label in rows]
