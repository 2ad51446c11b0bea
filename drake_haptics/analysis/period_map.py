"""A linear map of a diagram over one period: what its stability follows from."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.common.one_line import one_line


@dataclass(frozen=True)
class PeriodMap:
    """x⁺ = A x about an equilibrium, x = [x_c; all discrete groups].

    The state is that just before a sampling instant.

    Attributes:
        A: (n, n).
        period_s: s.
        state_names: (n,), as "plant/tool_x" or "controller/xd[0]".
        state: (n,) the equilibrium.
        quaternions: Positions in the state of the four numbers of each unit
            quaternion, whose length is no motion.
        equilibrium_residual: Largest change of a state over the period, relative to
            its size or 1, whichever is larger.
    """

    A: np.ndarray
    period_s: float
    state_names: tuple[str, ...]
    state: np.ndarray
    quaternions: tuple[tuple[int, ...], ...]
    equilibrium_residual: float

    __repr__ = one_line

    @on_one_blas_thread
    def eigenvalues(self) -> np.ndarray:
        """Returns the eigenvalues of A (n,), complex, largest magnitude first."""
        values = np.linalg.eigvals(self.A).astype(complex)
        return values[np.argsort(-np.abs(values), kind="stable")]

    def spectral_radius(self) -> float:
        """Returns the largest magnitude of an eigenvalue: stable below 1."""
        return float(np.abs(self.eigenvalues()).max())

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields and the eigenvalues ([re, im] each), ready for JSON."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in values.items()
        } | {"eigenvalues": [[z.real, z.imag] for z in self.eigenvalues()]}


def check_return(
    x: np.ndarray,
    change: np.ndarray,
    names: tuple[str, ...],
    tolerance: float,
) -> float:
    """Returns the largest relative change of a state over a period.

    Args:
        x: (n,) state.
        change: (n,) what one period adds to it.
        names: (n,).
        tolerance: Its bound, relative to the state's size or 1.

    Raises:
        ValueError: A state changes by more; names the one that changes most.
    """
    relative = np.abs(change) / np.maximum(np.abs(x), 1.0)
    worst = int(np.argmax(np.where(np.isfinite(relative), relative, np.inf)))
    if not relative[worst] <= tolerance:
        raise ValueError(
            f"not an equilibrium: {names[worst]} changes by {change[worst]:.3g} in one"
            f" period, more than {tolerance:g} of its size or 1: use the context that"
            " find_equilibrium returns"
        )
    return float(relative[worst])
