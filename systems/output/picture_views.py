"""What of a loop's picture can be shown or hidden."""

from __future__ import annotations

from types import MappingProxyType

PICTURE_VIEWS = MappingProxyType(
    {
        "pieces": "Convex pieces",
        "virtual": "Virtual facets",
        "ghost": "Handle's ghost",
        "contacts": "Contacts",
        "forces": "Forces",
    }
)
"""Names of the views and what people read.

`pieces` colors each convex piece; `virtual` shows, translucent, the facets of pieces
that are not on the mesh; `ghost` is where the handle wants the tool, with the coupling;
`contacts` are the small arrows, `forces` the large ones.
"""

SHOWN_AT_FIRST = frozenset({"ghost", "contacts", "forces"})
"""Views that are to be seen until somebody hides them."""


def check_view(view: str) -> None:
    """Checks the name of a view.

    Raises:
        ValueError: There is no such view.
    """
    if view not in PICTURE_VIEWS:
        known = ", ".join(PICTURE_VIEWS)
        raise ValueError(f"view must be one of {known}, is {view!r}")
