"""Where the C headers of the device protocol are, for the build of a driver."""

from __future__ import annotations

from pathlib import Path


def get_include() -> str:
    """Returns the folder to give to a C or C++ compiler with `-I`.

    It holds `drake_haptics/wire.h` (the packets) and `drake_haptics/gate.h` (what a
    driver obeys), as `numpy.get_include` does for NumPy's.
    """
    return str(Path(__file__).parents[1] / "include")
