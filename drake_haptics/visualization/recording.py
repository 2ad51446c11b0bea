"""Writes what Meshcat shows, with its animation and what was felt, as one file."""

from __future__ import annotations

import html
import json
from importlib.resources import files
from pathlib import Path

import numpy as np
from pydrake.geometry import Meshcat

from drake_haptics.common.colors import FORCE_INK, TORQUE_INK, make_legend, write_css

_PLAYER = "recording_player.html"
# Where the player wants its numbers.
_TRACES = "/* the traces */"


def write_recording(
    meshcat: Meshcat,
    path: Path,
    title: str,
    felt: np.ndarray,
    *,
    max_force_N: float,
    max_torque_Nm: float,
    has_friction: bool = False,
) -> None:
    """Writes the page as one HTML file that needs nothing else.

    Below the scene are force and torque over time, and what plays, stops and moves
    through both.

    Args:
        meshcat: Whose recording has been published.
        path: The file to write.
        title: Heading of the legend.
        felt: (n, 3) as `HapticVisualizer.recorded_sizes`.
        max_force_N: The device's largest force, N.
        max_torque_Nm: The device's largest torque, N·m.
        has_friction: Whether friction is drawn.

    Raises:
        OSError: The file cannot be written.
    """
    rows = "".join(
        f'<div><span style="display:inline-block;width:0.8em;height:0.8em;'
        f"margin-right:0.6em;border-radius:50%;background:{row['color']}"
        f'"></span>{html.escape(row["label"])}</div>'
        for row in make_legend(has_friction)
    )
    legend = (
        '<div id="legend" style="position:fixed;left:1.2em;top:1.2em;'
        "max-width:19em;padding:0.7em 1em;font:12px/1.55 sans-serif;color:#333;"
        'background:rgba(255,255,255,0.75);border-radius:0.5em">'
        f"<b>{html.escape(title)}</b>{rows}"
        "<div>small arrows: contacts; large ones: forces of clusters</div></div>"
    )
    time_s, force_N, torque_Nm = felt.T
    traces = {
        "time_s": time_s.round(6).tolist(),
        "force": force_N.round(4).tolist(),
        "torque": (1e3 * torque_Nm).round(2).tolist(),
        "of": {
            "force": {"color": write_css(FORCE_INK), "limit": max_force_N},
            "torque": {"color": write_css(TORQUE_INK), "limit": 1e3 * max_torque_Nm},
        },
    }
    player = (
        files("drake_haptics.visualization")
        .joinpath(_PLAYER)
        .read_text(encoding="utf-8")
    )
    player = player.replace(_TRACES, json.dumps(traces), 1)
    page = meshcat.StaticHtml().replace("</body>", f"{legend}{player}</body>", 1)
    path.write_text(page, encoding="utf-8")
