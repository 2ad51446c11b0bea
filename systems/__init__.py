"""The systems of the haptic loop.

They are in sub-packages by purpose and are imported on first use, so that a system that
a scene does not need is not even loaded.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
