"""Where a page goes whose picture is written beside it."""

from __future__ import annotations

from pathlib import Path

from drake_haptics.common.errors import UserError


def check_page_path(path: Path) -> None:
    """Checks that page and picture are two files.

    Raises:
        UserError: The path has the picture's suffix.
    """
    if path.suffix == ".png":
        raise UserError(
            f"the page must not be called {path.name}: its picture will be. Give a"
            " name that ends with .html"
        )
