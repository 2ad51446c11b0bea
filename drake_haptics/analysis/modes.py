"""A linear map over one period, and its modes."""

from __future__ import annotations

import enum
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import block_diag, eig

from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.common.one_line import one_line
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.report.plain_data import to_plain_data


@dataclass(frozen=True)
class PeriodMap:
    """x⁺ = A x about an equilibrium, x = [x_c; all discrete groups].

    x is the state just before a sampling instant.

    Attributes:
        A: (n, n) matrix of the map.
        period_s: Period of the map, s.
        state_names: (n,) names, such as "plant/tool_x" or "controller/xd[0]".
        state: (n,) the equilibrium.
        quaternions: Positions in the state of the four numbers of each unit quaternion,
            whose length is not a motion.
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
        """Returns the largest magnitude of an eigenvalue, which is stable below 1."""
        return float(np.abs(self.eigenvalues()).max())

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields and the eigenvalues ([re, im] each), ready for JSON."""
        plain: dict[str, Any] = to_plain_data(self)
        return plain | {"eigenvalues": [[z.real, z.imag] for z in self.eigenvalues()]}


def check_return(
    x: np.ndarray, change: np.ndarray, names: tuple[str, ...], tolerance: float
) -> float:
    """Returns the largest relative change of a state over a period.

    Args:
        x: (n,) state.
        change: (n,) change of the state over one period.
        names: (n,) names of the states.
        tolerance: Bound of the change, relative to the state's size or 1.

    Raises:
        ValueError: A state changes by more; the message names the one that changes
            most.
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


# Parts of the states' paths that every haptic loop has.
_KNOWN_PARTS = re.compile(r"(?<![^/])(device/simulated_arm/arm|device|step|sample)/")
# The state of one joint, angle or rate, and one of the tool, pose or velocity.
_JOINT = re.compile(r"device/simulated_arm/arm/(\w+)_[qw]")
_TOOL = re.compile(r"(?:haptic_tool|constraint_tool_step)/step/([qvw]?)([wxyz])")
_TOOL_TURNING = "tool turning"


def list_parts(states: Iterable[str]) -> list[str]:
    """Returns the names of the parts that move, each once.

    Parts of a haptic loop are named in words: "elbow joint" for the rate
    "device/simulated_arm/arm/elbow_joint_w" and the angle "..._q"; "tool along x" for
    "haptic_tool/step/x" and "vx", and "tool about x" for "wx", along axes of the world.
    The elements of the tool's quaternion have no axis; they are "tool turning", which
    is left out if a rate, which has an axis, is also named.

    Args:
        states: Names of states, by decreasing participation.
    """
    parts = list(dict.fromkeys(map(_name_part, states)))
    if any(part.startswith("tool about") for part in parts):
        return [part for part in parts if part != _TOOL_TURNING]
    return parts


def _name_part(state: str) -> str:
    if joint := _JOINT.fullmatch(state):
        return joint[1].replace("_", " ")
    if tool := _TOOL.fullmatch(state):
        kind, axis = tool.groups()
        if kind == "q":
            return _TOOL_TURNING
        return f"tool {'about' if kind == 'w' else 'along'} {axis}"
    return shorten_path(state)


def shorten_path(name: str) -> str:
    """Returns the name of a state without the parts of its path that all loops have.

    "haptic_tool/step/qw" becomes "haptic_tool/qw".
    """
    return _KNOWN_PARTS.sub("", name)


# An eigenvalue this near to 1 cannot be distinguished from 1; the two of a free mass,
# which are exactly 1, are found to the square root of round-off.
NEUTRAL = 1e-6
# A remembered value has eigenvalue 0; that of a chain of three is found to the third
# root of round-off.
_MEMORY = 1e-3
# Smaller growth cannot be distinguished from none.
_ROUND_OFF = 1e-9
# A mode has died out when it has fallen to this share.
_DIED_OUT = 0.02
# States with a smaller share of the largest participation are not named.
_NAMED = 0.3
_MOST_NAMED = 3


class ModeKind(enum.Enum):
    """The meaning of an eigenvalue."""

    MOTION = "motion"
    """A motion that grows or dies out, oscillating or not."""
    NEUTRAL = "neutral"
    """A displacement that nothing drives back, as of a free body or of friction."""
    MEMORY = "memory"
    """A held or remembered value that is replaced at the next samples."""
    QUATERNION_LENGTH = "quaternion length"
    """The length of a unit quaternion, which is not a motion."""


@dataclass(frozen=True)
class Mode:
    """One eigenvalue, or a conjugate pair, of a linear map over a period.

    Attributes:
        kind: Meaning of the mode.
        eigenvalue: λ; that with the positive imaginary part if it is one of a pair.
        period_s: T of the map, s.
        participation: (name of the state, share) of the participating states, largest
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
        """`|λ| - 1`, which is unstable above 0."""
        return abs(self.eigenvalue) - 1.0

    @property
    def frequency_hz(self) -> float:
        """Frequency of the swing, Hz: 0 without one, at most half the sampling rate."""
        angle = math.atan2(self.eigenvalue.imag, self.eigenvalue.real)
        return abs(angle) / (2.0 * math.pi * self.period_s)

    @property
    def damping_ratio(self) -> float:
        """ζ of s = ln λ / T: 1 for a decay without oscillation, below 0 for growth."""
        if self.eigenvalue == 0.0:
            return 1.0
        s = np.log(complex(self.eigenvalue))
        return 0.0 if s == 0.0 else float(-s.real / abs(s))

    @property
    def decay_time_s(self) -> float:
        """Time in which the motion falls to 2 %, s; infinite if it does not."""
        magnitude = abs(self.eigenvalue)
        if magnitude == 0.0:
            return 0.0
        if magnitude >= 1.0:
            return math.inf
        return self.period_s * math.log(_DIED_OUT) / math.log(magnitude)

    def describe(self) -> str:
        """Returns one line, such as "27.3 Hz, damped 4 % of critical, ...".

        The moving parts of a haptic loop are named in words, "elbow joint" for
        "device/simulated_arm/arm/elbow_joint_q"; `participation` has the names of the
        states.
        """
        largest = self._list_largest()
        if self.kind is ModeKind.QUATERNION_LENGTH:
            names = " and ".join(map(shorten_path, largest[:_MOST_NAMED]))
            return f"no motion: the length of the quaternion {names}"
        mostly = " and ".join(list_parts(largest)[:_MOST_NAMED])
        if self.kind is ModeKind.NEUTRAL:
            return f"neutral: nothing drives it back; mostly {mostly}"
        if self.kind is ModeKind.MEMORY:
            return f"a held or remembered value, soon replaced; mostly {mostly}"
        return f"{self._describe_motion()}; mostly {mostly}"

    def to_dict(self) -> dict[str, Any]:
        """Returns all properties and the description, ready for JSON."""
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
        """Returns the names of the states with the largest participation."""
        largest = self.participation[0][1]
        return [name for name, share in self.participation if share >= _NAMED * largest]


@on_one_blas_thread
def find_modes(linear: PeriodMap) -> tuple[Mode, ...]:
    """Returns the modes of a linear map over a period.

    Args:
        linear: The map from `linearize_sampled` or `calc_monodromy`.

    Returns:
        Motions first, by decreasing growth; then neutral modes, memories, and lengths
        of quaternions. A conjugate pair is one mode.
    """
    require_kinds(
        "linearize_sampled and calc_monodromy make one", linear=(linear, PeriodMap)
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
    """Returns the frequency of a motion and what moves, as in "245 Hz; mostly ...".

    It is meant for a motion at the limit of stability, which neither grows nor dies
    out.
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
    # A state precedes its rate if both have the same share.
    order = np.argsort(-np.round(shares, 9), kind="stable")
    participation = tuple(
        (linear.state_names[i], float(shares[i])) for i in order if shares[i] > 1e-6
    )
    if not participation:
        participation = ((linear.state_names[0], 0.0),)
    return Mode(kind, value, linear.period_s, participation)


def _split_quaternions(linear: PeriodMap) -> tuple[np.ndarray, list[np.ndarray]]:
    """Returns a basis of the possible motions, and quaternions' lengths, (n,) each.

    The length is a left eigenvector with eigenvalue 1 of a map that keeps it, and the
    map takes the subspace normal to it to itself. The basis leaves the length out, so
    that it cannot mix with true modes at 1.
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
