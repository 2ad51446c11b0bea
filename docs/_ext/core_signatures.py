"""Shows the signatures of the compiled core as those of Python: without `self`."""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx


def _leave_out_self(
    app: Sphinx,
    what: str,
    name: str,
    thing: Any,
    options: Any,
    arguments: str | None,
    returned: str | None,
) -> tuple[str, str | None] | None:
    """Takes `self` out of what nanobind says of methods and constructors."""
    if arguments is None or not arguments.startswith("(self"):
        return None
    return "(" + arguments.removeprefix("(self").removeprefix(", "), returned


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers it."""
    app.connect("autodoc-process-signature", _leave_out_self)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
