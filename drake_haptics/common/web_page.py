"""Adds to the pages that Meshcat writes."""

from __future__ import annotations

_VIEWPORT = '<meta name="viewport" content="width=device-width, initial-scale=1">'


def extend_page(page: str, body: str) -> str:
    """Returns a page with more in its body, as wide as its screen, a phone's too.

    Args:
        page: HTML of the page.
        body: HTML that is put at the end of its body.
    """
    page = page.replace("<head>", f"<head>{_VIEWPORT}", 1)
    return page.replace("</body>", f"{body}</body>", 1)
