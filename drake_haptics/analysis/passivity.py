"""Calculates the physical damping that makes a sampled wall passive.

A device with damping matrix D moves in continuous time. Its position is sampled, a
discrete law -H(z) x gives a force, and the force is held for a period T. The loop
cannot be driven into motion by any passive hand if and only if

    D - R(ω) is positive semidefinite for 0 < ω <= π/T, with
    R(ω) = T/(2 (1 - cos ωT)) · Herm[(1 - e^(-jωT)) H(e^(jωT))],

Herm[M] = (M + M*)/2. On one axis that is the condition of Colgate and Schenkel (1997),
b > T/(2 (1 - cos ωT)) Re{(1 - e^(-jωT)) H(e^(jωT))}. For several axes it follows in the
same way (docs/stability-theory.md): at a baseband frequency ω the motion is any set of
aliases v_n at ω + 2πn/T. The samples determine only their sum s = Σ v_n/(jω_n). Of all
motions with the same s the device dissipates the least in that with v_n ∝ s/ω_n, namely
s* D s / Σ 1/ω_n², where Σ 1/ω_n² = T²/(2 (1 - cos ωT)).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np
from scipy.optimize import minimize_scalar

from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.common.colors import INKS, PASSIVITY
from drake_haptics.common.one_line import one_line
from drake_haptics.common.value_checks import check_at_least, check_positive
from drake_haptics.report.plot_labels import find_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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


# Accuracy of poles on the unit circle.
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
    check_positive(period_s=period_s)
    check_at_least(0, delay_samples=delay_samples)
    K, B = np.atleast_2d(stiffness), np.atleast_2d(damping)

    def H(z: complex) -> np.ndarray:
        return (K + B * (z - 1.0) / (period_s * z)) * z**-delay_samples

    return H


def as_transfer(
    H: TransferFunction, period_s: float
) -> tuple[Callable[[complex], np.ndarray], np.ndarray]:
    """Returns H as a function that returns (m, m), and its poles.

    The poles are those of a linear system; those of a function are not known.

    Raises:
        ValueError: The system has another period, is unstable or is not square.
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
    return (_square(lambda z: C @ np.linalg.solve(z * identity - A, B) + D), poles)


def _matrix(system: object, name: str) -> np.ndarray:
    value = getattr(system, name)
    return np.asarray(value() if callable(value) else value, dtype=float)


def _square(
    function: Callable[[complex], complex | np.ndarray],
) -> Callable[[complex], np.ndarray]:
    """Returns a function whose values are (m, m) and finite; it raises ValueError."""

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


_POINTS = 400
# The condition is even in ω: this near to 0 it equals its limit to a relative 1e-8, and
# cot(ωT/2) loses only four digits.
_LOWEST_ANGLE = 1e-4
# Points of the grid around a pole's angle, in half widths of its resonance.
_NEAR_POLES = np.array([-30, -10, -3, -1, -0.5, 0, 0.5, 1, 3, 10, 30])
# Number of the highest points of the grid that are refined.
_PEAKS = 3


@dataclass(frozen=True)
class Passivity:
    """The damping that makes a sampled law passive.

    Attributes:
        period_s: T, s.
        frequencies_Hz: (n,), increasing; the last is 1/(2 T).
        required_matrix: R(ω), (n, m, m), Hermitian, N·s/m (N·m·s/rad).
        required_damping: Its largest eigenvalue, (n,): the b of a device that damps all
            m axes alike, D = b I. It is meaningless if axes of translation and rotation
            are mixed; see `calc_usage`.
        worst_damping: The largest of `required_damping`: b must be larger.
        worst_frequency_Hz: Frequency of `worst_damping`; 0 if it is the limit at
            standstill.
    """

    period_s: float
    frequencies_Hz: np.ndarray
    required_matrix: np.ndarray
    required_damping: np.ndarray
    worst_damping: float
    worst_frequency_Hz: float

    __repr__ = one_line

    @on_one_blas_thread
    def calc_usage(self, damping: np.ndarray) -> np.ndarray:
        """Returns how much of a damping is needed, (n,), without unit.

        That is the largest eigenvalue of L⁻¹ R(ω) L⁻ᵀ with D = L Lᵀ: passive if it is
        at most one. Axes of different units may be mixed.

        Args:
            damping: D of device (and hand), symmetric and positive definite, (m, m).

        Raises:
            ValueError: D has another shape or is not positive definite.
        """
        D = np.asarray(damping, dtype=float)
        axes = self.required_matrix.shape[1]
        if D.shape != (axes, axes):
            raise ValueError(f"damping must be ({axes}, {axes}), is {D.shape}")
        if not np.allclose(D, D.T):
            raise ValueError("damping must be symmetric")
        try:
            L = np.linalg.inv(np.linalg.cholesky(D))
        except np.linalg.LinAlgError as error:
            raise ValueError("damping must be positive definite") from error
        return np.linalg.eigvalsh(L @ self.required_matrix @ L.T)[:, -1]

    def plot(
        self, axes: Axes | None = None, available: Mapping[str, float] | None = None
    ) -> Axes:
        """Draws the required damping over frequency.

        Args:
            axes: The axes to draw on. Defaults to new ones.
            available: Available damping by name, such as "device", N·s/m.
        """
        axes = find_axes(axes)
        axes.plot(
            self.frequencies_Hz,
            self.required_damping,
            color=PASSIVITY,
            label="required",
        )
        axes.plot(self.worst_frequency_Hz, self.worst_damping, "o", color=PASSIVITY)
        for ink, (name, damping) in zip(cycle(INKS), (available or {}).items()):
            axes.axhline(damping, ls="--", color=ink, label=name)
        axes.set_xlim(0.0, self.frequencies_Hz[-1])
        axes.set_xlabel("frequency, Hz")
        axes.set_ylabel("damping, N·s/m or N·m·s/rad")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Returns all fields but the matrix, ready for JSON."""
        return {
            "period_s": self.period_s,
            "frequencies_Hz": self.frequencies_Hz.tolist(),
            "required_damping": self.required_damping.tolist(),
            "worst_damping": self.worst_damping,
            "worst_frequency_Hz": self.worst_frequency_Hz,
        }


@on_one_blas_thread
def calc_passivity(
    H: TransferFunction,
    period_s: float,
    frequencies_Hz: Sequence[float] | np.ndarray | None = None,
) -> Passivity:
    """Calculates how much damping makes a sampled law passive, over frequency.

    Args:
        H: The law: the force that the device shows is -H(z) x of the sampled
            positions. A function of complex z that returns a number or an (m, m)
            array, as `make_spring_damper` does; or a linear system of period T
            with A, B, C and D, such as pydrake's `LinearSystem`, whose input is x and
            whose output is the force that resists, +H x.
        period_s: T, s.
        frequencies_Hz: Frequencies, 0 < f <= 1/(2 T), or 0 for the limit. Defaults to a
            grid that is dense at the poles of a linear system and refined at its three
            highest peaks.

    Raises:
        ValueError: The period is not positive or not that of the system, a frequency is
            out of range, or H is not square or not finite.
    """
    check_positive(period_s=period_s)
    transfer, poles = as_transfer(H, period_s)
    nyquist_Hz = 0.5 / period_s

    def matrix_at(angle: float) -> np.ndarray:
        return _calc_required_matrix(transfer, max(angle, _LOWEST_ANGLE), period_s)

    if frequencies_Hz is None:
        angles = _refine(_make_grid(poles), matrix_at)
    else:
        f = np.sort(np.asarray(frequencies_Hz, dtype=float))
        if f.size == 0 or not (f[0] >= 0.0 and f[-1] <= nyquist_Hz * (1.0 + 1e-12)):
            raise ValueError(
                f"frequencies_Hz must be from 0 to 1/(2 T), {nyquist_Hz:g} Hz"
            )
        angles = np.minimum(2.0 * math.pi * f * period_s, math.pi)
    required = np.array([matrix_at(angle) for angle in angles])
    damping = np.linalg.eigvalsh(required)[:, -1]
    worst = int(np.argmax(damping))
    hertz = angles / (2.0 * math.pi * period_s)
    return Passivity(
        period_s=period_s,
        frequencies_Hz=hertz,
        required_matrix=required,
        required_damping=damping,
        worst_damping=float(damping[worst]),
        worst_frequency_Hz=float(hertz[worst]),
    )


def _calc_required_matrix(
    transfer: Callable[[complex], np.ndarray], angle: float, period_s: float
) -> np.ndarray:
    """Returns R at ωT, (m, m).

    T/2 (Re H - cot(ωT/2) Im H), where Re and Im are the two Hermitian parts of
    H = Re H + j Im H: the module's expression with its small differences canceled.
    """
    H = transfer(complex(math.cos(angle), math.sin(angle)))
    real, imaginary = (H + H.conj().T) / 2.0, (H - H.conj().T) / 2.0j
    return period_s / 2.0 * (real - imaginary / math.tan(angle / 2.0))


def _make_grid(poles: np.ndarray) -> np.ndarray:
    """Returns angles in [0, π], which are dense where H may change fast."""
    even = np.linspace(0.0, math.pi, _POINTS)
    slow = np.geomspace(_LOWEST_ANGLE, even[1], _POINTS // 8)
    # A lightly damped pole rings in a band as wide as its distance from the circle.
    width = np.maximum(1.0 - np.abs(poles), 1e-9)
    near = np.abs(np.angle(poles))[:, None] + width[:, None] * _NEAR_POLES
    every = np.concatenate([even, slow, near.ravel()])
    return np.unique(every[(every == 0.0) | (every >= _LOWEST_ANGLE)].clip(0, math.pi))


def _refine(angles: np.ndarray, matrix_at: Callable[[float], np.ndarray]) -> np.ndarray:
    """Returns the angles with the tops of the highest peaks added."""

    def damping_at(angle: float) -> float:
        return float(np.linalg.eigvalsh(matrix_at(angle))[-1])

    values = np.array([damping_at(angle) for angle in angles])
    inner = values[1:-1]
    peaks = 1 + np.flatnonzero((inner >= values[:-2]) & (inner >= values[2:]))
    # The search is over the offset from a grid point, because it is exact only to half
    # of the digits of its variable.
    tops = [
        angles[i]
        + minimize_scalar(
            lambda offset, middle=angles[i]: -damping_at(middle + offset),
            bounds=(angles[i - 1] - angles[i], angles[i + 1] - angles[i]),
            method="bounded",
            options={"xatol": 1e-12},
        ).x
        for i in peaks[np.argsort(values[peaks])[-_PEAKS:]]
    ]
    return np.unique(np.concatenate([angles, tops]))
