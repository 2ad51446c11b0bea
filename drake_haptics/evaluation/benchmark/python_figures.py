"""What one pair query costs from Python."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PythonFigures:
    """What one query costs a Python program, from the pose to the distance.

    Attributes:
        kind: of the pair.
        size: vertices of each body.
        ours_us: median, this package, tracked, µs.
        coal_us: median of the faster of coal's starts, µs.
    """

    kind: str
    size: int
    ours_us: float
    coal_us: float

    @property
    def ratio(self) -> float:
        """Of this package to coal."""
        return self.ours_us / self.coal_us
