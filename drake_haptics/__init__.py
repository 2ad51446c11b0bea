"""Six-degree-of-freedom haptic rendering of arbitrary meshes, as Drake systems.

Most programs need only the names of this module; `drake_haptics.geometry`,
`drake_haptics.systems`, `drake_haptics.simulation` and `drake_haptics.analysis` offer
more. The geometry (`load_mesh`, `decompose`, `ConvexPair`, `ContactTracker`,
`SceneTracker`) works without Drake, which is imported only when a name that needs it is
used.
"""

from __future__ import annotations

from importlib import import_module

import lazy_loader

_get_public, _, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    """Imports a public name from its module on first use."""
    if name == "__version__":
        return import_module("importlib.metadata").version(__name__)
    if name not in __all__:
        raise AttributeError(_describe_unknown(name))
    return _get_public(name)


def __dir__() -> list[str]:
    """Lists the public names, for completion."""
    return sorted([*__all__, "__version__"])


def _describe_unknown(name: str) -> str:
    from difflib import get_close_matches
    from importlib.util import find_spec

    said = f"module {__name__!r} has no attribute {name!r}"
    if not name.startswith("_") and find_spec(f"{__name__}.{name}") is not None:
        return f"{said} yet; it is a module: import {__name__}.{name}"
    near = get_close_matches(name, __all__, n=1)
    return f"{said}; did you mean {near[0]!r}?" if near else said
