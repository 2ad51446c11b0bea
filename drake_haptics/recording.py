"""Writes what Meshcat shows, with its animation, as one file."""

from __future__ import annotations

import html
from pathlib import Path

from pydrake.geometry import Meshcat

from drake_haptics.colors import make_legend


def write_recording(
    meshcat: Meshcat, path: Path, title: str, *, has_friction: bool = False
) -> None:
    """Writes the page as one HTML file that needs nothing else.

    Args:
        meshcat: Whose recording has been published.
        path: The file to write.
        title: Heading of the legend.
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
        '<div id="legend" style="position:fixed;left:1.2em;bottom:1.2em;'
        "max-width:19em;padding:0.7em 1em;font:12px/1.55 sans-serif;color:#333;"
        'background:rgba(255,255,255,0.75);border-radius:0.5em">'
        f"<b>{html.escape(title)}</b>{rows}"
        "<div>small arrows: contacts; large ones: forces of clusters</div></div>"
    )
    page = meshcat.StaticHtml().replace("</body>", f"{legend}</body>", 1)
    path.write_text(page, encoding="utf-8")
