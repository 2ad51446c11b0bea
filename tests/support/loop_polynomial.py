"""The characteristic polynomial of a sampled spring and damper with whole delays."""

from __future__ import annotations

import numpy as np


def make_loop_polynomial(alpha: float, beta: float, delay_samples: int) -> np.ndarray:
    """Returns 2 z^(d+1) (z - 1)² + (α z + β (z - 1)) (z + 1), highest power first."""
    mass = np.zeros(delay_samples + 4)
    mass[:3] = 2.0, -4.0, 2.0
    return np.polyadd(mass, np.polymul([alpha + beta, -beta], [1.0, 1.0]))
