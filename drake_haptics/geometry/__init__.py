"""Meshes, their convex pieces and contacts between them, without Drake.

The names are imported on first use. Only the modules of
`drake_haptics.geometry.parsing`, which read the shapes of Drake's bodies, import Drake.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
