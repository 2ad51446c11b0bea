"""The eigenvalues of a sampled system in words: how fast, how damped, what moves."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import block_diag, eig

from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.motion_words import list_parts, shorten_path
from drake_haptics.analysis.period_map import PeriodMap
from drake_haptics.common.one_line import one_line
from drake_haptics.common.type_checks import require_kinds

# An eigenvalue this near to 1 moves too slowly to be told from one that stays; the
# two of a free mass, which are exactly 1, are found to the root of round-off.
NEUTRAL = 1e-6
# A remembered value is gone after as many periods as it is remembered, eigenvalue 0;
# of a chain of three, 0 is found to the third root of round-off.
_MEMORY = 1e-3
# Growth that is no more than this cannot be told from none.
_ROUND_OFF = 1e-9
# A mode has died out when it has fallen to this.
_DIED_OUT = 0.02
# States with less than this part of the largest participation are not named.
_NAMED = 0.3
_MOST_NAMED = 3


class ModeKind(enum.Enum):
    """What an eigenvalue means."""

    MOTION = "motion"
    """Grows, or dies out, swinging or not."""
    NEUTRAL = "neutral"
    """Stays where it is put: nothing drives it back, as a free body or friction."""
    MEMORY = "memory"
    """A held or remembered value, replaced at the next samples."""
    QUATERNION_LENGTH = "quaternion length"
    """No motion at all: the length of a unit quaternion."""


@dataclass(frozen=True)
class Mode:
    """One eigenvalue, or a conjugate pair, of a linear map over a period.

    Attributes:
        kind: What it means.
        eigenvalue: λ, that with the positive imaginary part.
        period_s: T of the map, s.
        participation: (name of the state, share) of the states that take part, largest
            first; the shares of all states add up to 1 (Pérez-Arriaga, Verghese and
            Schweppe 1982: the product of left and right eigenvectors).
    """

    kind: ModeKind
    eigenvalue: complex
    period_s: float
    participation: tuple[tuple[str, float], ...]

    __repr__ = one_line

    @property
    def growth_per_period(self) -> float:
        """`|λ| - 1`: above 0 unstable."""
        return abs(self.eigenvalue) - 1.0

    @property
    def frequency_hz(self) -> float:
        """Of the swing, Hz: 0 for one without, at most half the sampling rate."""
        angle = math.atan2(self.eigenvalue.imag, self.eigenvalue.real)
        return abs(angle) / (2.0 * math.pi * self.period_s)

    @property
    def damping_ratio(self) -> float:
        """ζ of s = ln λ / T: 1 for a decay without swing, below 0 if it grows."""
        if self.eigenvalue == 0.0:
            return 1.0
        s = np.log(complex(self.eigenvalue))
        return 0.0 if s == 0.0 else float(-s.real / abs(s))

    @property
    def decay_time_s(self) -> float:
        """Time in which it falls to 2 %, s; infinite if it does not fall."""
        magnitude = abs(self.eigenvalue)
        if magnitude == 0.0:
            return 0.0
        if magnitude >= 1.0:
            return math.inf
        return self.period_s * math.log(_DIED_OUT) / math.log(magnitude)

    def describe(self) -> str:
        """Returns it in a line, as "27.3 Hz, damped 4 % of critical, ...".

        What moves in a haptic loop is named in words, "elbow joint" for
        "device/simulated_arm/arm/elbow_joint_q"; `participation` has the names of the
        states.
        """
        largest = self._list_largest()
        if self.kind is ModeKind.QUATERNION_LENGTH:
            names = " and ".join(map(shorten_path, largest[:_MOST_NAMED]))
            return f"no motion: the length of the quaternion {names}"
        mostly = " and ".join(list_parts(largest)[:_MOST_NAMED])
        if self.kind is ModeKind.NEUTRAL:
            return f"stays where it is put, nothing drives it back; mostly {mostly}"
        if self.kind is ModeKind.MEMORY:
            return f"a held or remembered value, soon replaced; mostly {mostly}"
        return f"{self._describe_motion()}; mostly {mostly}"

    def to_dict(self) -> dict[str, Any]:
        """Returns all figures and the sentence, ready for JSON."""
        decay_time_s = self.decay_time_s
        return {
            "kind": self.kind.value,
            "eigenvalue": [self.eigenvalue.real, self.eigenvalue.imag],
            "period_s": self.period_s,
            "frequency_hz": self.frequency_hz,
            "damping_ratio": self.damping_ratio,
            "decay_time_s": decay_time_s if math.isfinite(decay_time_s) else None,
            "growth_per_period": self.growth_per_period,
            "participation": [list(part) for part in self.participation],
            "description": self.describe(),
        }

    def _describe_motion(self) -> str:
        percent, ratio = 100.0 * self.growth_per_period, self.damping_ratio
        swings = self.eigenvalue.imag != 0.0 or self.eigenvalue.real < 0.0
        rate = f"{self.frequency_hz:.3g} Hz" if swings else "no swing"
        if abs(self.growth_per_period) <= _ROUND_OFF:
            return f"{rate}, neither grows nor dies out"
        if percent > 0.0:
            return f"grows by {percent:.2g} % each period: unstable; {rate}"
        damped = f", damped {100.0 * ratio:.2g} % of critical" if swings else ""
        return f"{rate}{damped}, dies out in {self.decay_time_s:.2g} s"

    def _list_largest(self) -> list[str]:
        """Returns the names of the states that take the largest part."""
        largest = self.participation[0][1]
        return [name for name, share in self.participation if share >= _NAMED * largest]


@on_one_blas_thread
def find_modes(linear: PeriodMap) -> tuple[Mode, ...]:
    """Returns the modes of a linear map over a period.

    Args:
        linear: From `linearize_sampled` or `monodromy`.

    Returns:
        Motions first, the fastest growing or slowest dying before the others; then
        those that are neutral, memories, and lengths of quaternions. A conjugate pair
        is one mode.
    """
    require_kinds(
        "linearize_sampled and monodromy make one", linear=(linear, PeriodMap)
    )
    basis, lengths = _split_quaternions(linear)
    values, left, right = eig(basis.T @ linear.A @ basis, left=True, right=True)
    modes = []
    for i, value in enumerate(values):
        if value.imag < 0.0:
            continue
        weights = np.abs((basis @ left[:, i]).conj() * (basis @ right[:, i]))
        modes.append(_make_mode(linear, _tell_kind(value), complex(value), weights))
    for length in lengths:
        modes.append(
            _make_mode(linear, ModeKind.QUATERNION_LENGTH, 1.0 + 0.0j, np.abs(length))
        )
    order = list(ModeKind)
    modes.sort(key=lambda mode: (order.index(mode.kind), -abs(mode.eigenvalue)))
    return tuple(modes)


def describe_motion(mode: Mode) -> str:
    """Returns how fast a motion swings and what moves, as "245 Hz; mostly ...".

    For a motion at the limit of stability, which neither grows nor dies out.
    """
    swings = mode.frequency_hz > 0.0
    rate = f"{mode.frequency_hz:.3g} Hz" if swings else "without swing"
    mostly = mode.describe().rpartition("; mostly ")[2]
    return f"{rate}; mostly {mostly}"


def _tell_kind(value: complex) -> ModeKind:
    if abs(value - 1.0) <= NEUTRAL:
        return ModeKind.NEUTRAL
    return ModeKind.MEMORY if abs(value) <= _MEMORY else ModeKind.MOTION


def _make_mode(
    linear: PeriodMap, kind: ModeKind, value: complex, weights: np.ndarray
) -> Mode:
    shares = weights / (weights.sum() or 1.0)
    # A state is named before its rate where both take the same part.
    order = np.argsort(-np.round(shares, 9), kind="stable")
    participation = tuple(
        (linear.state_names[i], float(shares[i])) for i in order if shares[i] > 1e-6
    )
    if not participation:
        participation = ((linear.state_names[0], 0.0),)
    return Mode(kind, value, linear.period_s, participation)


def _split_quaternions(linear: PeriodMap) -> tuple[np.ndarray, list[np.ndarray]]:
    """Returns a basis of what may move, and the lengths of quaternions, (n,) each.

    A map that keeps a quaternion's length has it as a left eigenvector of eigenvalue 1,
    and what is normal to it goes to itself: the basis leaves it out, so that it cannot
    mix with true modes at 1.
    """
    n = len(linear.A)
    lengths = []
    blocks: dict[int, np.ndarray] = {}
    for places in linear.quaternions:
        normal = np.zeros(n)
        normal[list(places)] = linear.state[list(places)]
        normal /= np.linalg.norm(normal)
        kept = np.abs(normal @ linear.A - normal).max() <= NEUTRAL
        if kept:
            lengths.append(normal)
            # The three directions in which a unit quaternion may turn.
            u, _, _ = np.linalg.svd(normal[list(places), np.newaxis])
            blocks[places[0]] = u[:, 1:]
    parts, at = [], 0
    while at < n:
        parts.append(blocks.get(at, np.eye(1)))
        at += len(parts[-1])
    return block_diag(*parts), lengths
