"""Analyzes the stability of a diagram: linear maps, modes, bounds and Z-width maps.

It works on any Drake diagram. The names are imported on first use.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
