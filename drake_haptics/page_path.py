"""Where a page goes whose picture is written beside it."""

from __future__ import annotations

from pathlib import Path


def check_page_path(path: Path) -> None:
    """Checks that page and picture are two files.

    Raises:
        ValueError: The path has the picture's suffix.
    """
    if path.suffix == ".png":
        raise ValueError(
            f"the page must not be called {path.name}: its picture will be. Give a"
            " name that ends with .html"
        )
