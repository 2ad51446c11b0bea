"""A sampled spring and damper on a damped mass, by its characteristic polynomial."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SampledLoop:
    """Evaluates the loop -(K x + B (x - x_before)/T), delayed and held, exactly.

    Args:
        mass: m, kg.
        period_s: T.
        damping: b, physical, N·s/m.
        delay: d, whole samples on top of the hold.
    """

    mass: float
    period_s: float
    damping: float = 0.0
    delay: int = 0

    def __call__(self, stiffness: float, damping: float) -> dict[str, float]:
        """Returns spectral radius, and the damping for passivity on a grid."""
        T = self.period_s
        roots = np.roots(self.make_polynomial(stiffness, damping))
        # Colgate and Schenkel, with H as it is felt: delayed by d samples.
        w = np.linspace(1e-4, np.pi, 1000) / T
        z = np.exp(1j * w * T)
        H = (stiffness + damping * (z - 1.0) / (T * z)) * z ** (-self.delay)
        needed = T / (2.0 * (1.0 - np.cos(w * T))) * ((1.0 - 1.0 / z) * H).real
        return {
            "spectral_radius": float(np.abs(roots).max()),
            "passive_damping": float(needed.max()),
        }

    def make_polynomial(self, stiffness: float, damping: float) -> np.ndarray:
        """Returns the coefficients, highest first.

            z^(d+1) (z - 1)(z - e) + (p z + q)(K z + B (z - 1)/T)

        where (p z + q)/((z - 1)(z - e)) is the mass with its damper under a hold. For
        b = 0 that is 2 z^(d+1) (z - 1)² + (α z + β (z - 1))(z + 1), times 1/2.
        """
        m, T, b = self.mass, self.period_s, self.damping
        delta = b * T / m
        e = np.exp(-delta)
        if b == 0.0:
            p = q = T**2 / (2.0 * m)
        else:
            p, q = (m / b**2) * np.array([delta - 1.0 + e, 1.0 - e - delta * e])
        motion = np.poly([1.0, e])
        law = [stiffness + damping / T, -damping / T]
        delayed = np.concatenate([motion, np.zeros(self.delay + 1)])
        return np.polyadd(delayed, np.polymul([p, q], law))


def refuse_stiff(stiffness: float, damping: float) -> dict[str, float]:
    """Has no equilibrium beyond 300 N/m."""
    if stiffness > 300.0:
        raise ValueError(f"no equilibrium at {stiffness:g} N/m")
    return {"spectral_radius": 0.9}
