"""The color scheme: valid, and pieces can be told apart."""

import itertools
from importlib.resources import files

import numpy as np

from drake_haptics.common import colors


def test_all_colors_are_valid():
    named = [value for name, value in vars(colors).items() if name[0].isupper()]
    named = [x for x in named if isinstance(x, tuple) and x is not colors.INKS]
    assert len(named) >= 12
    for color in [*named, *colors.INKS] + [colors.piece_color(i) for i in range(1000)]:
        assert len(color) == 4 and all(0 <= channel <= 1 for channel in color)


def test_contact_colors_are_green_and_red():
    assert np.argmax(colors.NEAR_CONTACT[:3]) == 1
    assert np.argmax(colors.PENETRATING_CONTACT[:3]) == 0


def test_the_first_pieces_differ_visibly():
    first = [np.array(colors.piece_color(i)) for i in range(12)]
    for a, b in itertools.combinations(first, 2):
        assert np.abs(a - b).max() > 0.05
    for a, b in itertools.pairwise(first):
        assert np.abs(a - b).max() > 0.25


def test_inks_are_read_on_white_and_told_apart():
    inks = {*colors.INKS, colors.OTHER_MODEL}
    for ink in inks:
        # The contrast that WCAG 2.1 asks of text.
        assert 1.05 / (calc_luminance(ink) + 0.05) >= 4.5
    for a, b in itertools.combinations([*inks, colors.FRONT], 2):
        assert np.abs(np.subtract(a, b)).max() > 0.15


def calc_luminance(color):
    """Relative luminance of an sRGB color, 1 of white."""
    channels = np.array(color[:3])
    linear = np.where(
        channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4
    )
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_the_legend_names_each_color_once():
    legend = colors.make_legend(has_friction=True)
    assert len({row["color"] for row in legend}) == len(legend) == 9
    assert [row for row in legend if "friction" not in row["label"]] == (
        colors.make_legend(has_friction=False)
    )
    assert colors.write_css(colors.HANDLE_GHOST) == "rgb(64 120 217 / 0.35)"


def test_the_pages_colors_are_those_of_the_scheme():
    style = files("drake_haptics.web").joinpath("page", "theme.css").read_text()
    for name, color in {
        "handle": colors.HANDLE_GHOST,
        "force": colors.FORCE_INK,
        "torque": colors.TORQUE_INK,
        "active": colors.NEAR_CONTACT,
        "fault": colors.PENETRATING_CONTACT,
        "top": colors.BACKGROUND_TOP,
        "bottom": colors.BACKGROUND_BOTTOM,
    }.items():
        red, green, blue = (round(255 * part) for part in color[:3])
        assert f"--{name}: rgb({red} {green} {blue});" in style
