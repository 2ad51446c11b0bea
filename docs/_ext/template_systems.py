"""Shows systems that Drake's `TemplateSystem` makes as what they are: classes.

Their class is called `AppliedWrenches_𝓣float𝓤`, which autodoc takes for an alias, and
is constructed by `_construct`, which autodoc does not look at.
"""

from __future__ import annotations

import inspect
from typing import Any

from sphinx.application import Sphinx

_NOT_OURS = "converter"  # the argument that Drake gives


def _is_instance(what: str, thing: Any) -> bool:
    return what == "class" and "_construct" in vars(thing)


def _name(app: Sphinx) -> None:
    """Gives such classes the names of the variables that hold them."""
    from drake_haptics.systems.plant.applied_wrenches import AppliedWrenches

    AppliedWrenches.__name__ = AppliedWrenches.__qualname__ = "AppliedWrenches"


def _sign(
    app: Sphinx, what: str, name: str, thing: Any, options: Any, *signature: Any
) -> tuple[str, str] | None:
    """Gives them the arguments of `_construct`."""
    if not _is_instance(what, thing):
        return None
    parameters = list(inspect.signature(thing._construct).parameters.values())
    shown = [p for p in parameters if p.name not in ("self", _NOT_OURS)]
    return str(inspect.Signature(shown)).replace("'", ""), ""


def _document(
    app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]
) -> None:
    """Adds the docstring of `_construct`; that of Drake's constructor is left out."""
    if not _is_instance(what, thing):
        return
    docstring = inspect.getdoc(thing) or ""
    if lines[0] != docstring.split("\n")[0]:
        lines.clear()
        return
    lines += ["", *(inspect.getdoc(thing._construct) or "").split("\n")]
    lines[:] = [line for line in lines if not line.strip().startswith(_NOT_OURS)]


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers all three."""
    app.connect("builder-inited", _name)
    app.connect("autodoc-process-signature", _sign)
    app.connect("autodoc-process-docstring", _document, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
