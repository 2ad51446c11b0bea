"""Discrete laws H(z), from functions, gains or state-space matrices."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Protocol, TypeAlias

import numpy as np


class StateSpace(Protocol):
    """A discrete linear system: x[k+1] = A x + B u, y = C x + D u.

    Its A, B, C and D are arrays, as of a `SampledLinearization`, or methods that
    return them, as of pydrake's `LinearSystem`.
    """

    @property
    def A(self) -> Any: ...  # noqa: D102

    @property
    def B(self) -> Any: ...  # noqa: D102

    @property
    def C(self) -> Any: ...  # noqa: D102

    @property
    def D(self) -> Any: ...  # noqa: D102


# Poles on the unit circle are calculated to this.
_ROUND_OFF = 1e-9

# From sampled positions to the force that resists them.
TransferFunction: TypeAlias = Callable[[complex], complex | np.ndarray] | StateSpace


def make_spring_damper(
    stiffness: float | np.ndarray,
    damping: float | np.ndarray,
    period_s: float,
    delay_samples: int = 0,
) -> Callable[[complex], np.ndarray]:
    """Returns H(z) = (K + B (z - 1)/(T z)) z⁻ᵈ, the backward difference as velocity.

    Args:
        stiffness: K, N/m; or (m, m) for m axes.
        damping: B, N·s/m; or (m, m).
        period_s: T, s.
        delay_samples: d, whole periods.

    Raises:
        ValueError: The period is not positive or the delay is negative.
    """
    if not period_s > 0.0:
        raise ValueError(f"period_s must be positive, is {period_s}")
    if delay_samples < 0:
        raise ValueError(f"delay_samples must be at least 0, is {delay_samples}")
    K, B = np.atleast_2d(stiffness), np.atleast_2d(damping)

    def H(z: complex) -> np.ndarray:
        return (K + B * (z - 1.0) / (period_s * z)) * z**-delay_samples

    return H


def as_transfer(
    H: TransferFunction, period_s: float
) -> tuple[Callable[[complex], np.ndarray], np.ndarray]:
    """Returns H as a function that returns (m, m), and its poles.

    The poles are those of a linear system; a function keeps its own to itself.

    Raises:
        ValueError: The system is of another period, unstable or not square.
    """
    if not all(hasattr(H, name) for name in "ABCD"):
        return _square(H), np.empty(0)  # type: ignore[arg-type]
    A, B, C, D = (_matrix(H, name) for name in "ABCD")
    period = getattr(H, "time_period", None) or getattr(H, "period_s", None)
    if callable(period):
        period = period()
    if period is not None and not math.isclose(period, period_s, rel_tol=1e-9):
        raise ValueError(
            f"period_s is {period_s:g}, but the system's is {period:g}"
            + ("; it is continuous" if period == 0.0 else "")
        )
    poles = np.linalg.eigvals(A) if A.size else np.empty(0)
    if (np.abs(poles) > 1.0 + _ROUND_OFF).any():
        raise ValueError(
            f"H is unstable, |z| = {np.abs(poles).max():.6g}: that is never passive"
        )
    identity = np.eye(len(A))
    return (
        _square(lambda z: C @ np.linalg.solve(z * identity - A, B) + D),
        poles,
    )


def _matrix(system: object, name: str) -> np.ndarray:
    value = getattr(system, name)
    return np.asarray(value() if callable(value) else value, dtype=float)


def _square(
    function: Callable[[complex], complex | np.ndarray],
) -> Callable[[complex], np.ndarray]:
    """Returns the function, made to return (m, m), finite, or to raise ValueError."""

    def H(z: complex) -> np.ndarray:
        try:
            value = np.atleast_2d(function(z))
        except np.linalg.LinAlgError:
            value = np.full((1, 1), np.nan)
        if value.shape[0] != value.shape[1]:
            raise ValueError(f"H must be square, is {value.shape}")
        if not np.isfinite(value).all():
            raise ValueError(
                f"H is not finite at {math.atan2(z.imag, z.real):.3g} rad per period:"
                " a pole on the unit circle is never passive"
            )
        return value

    return H
