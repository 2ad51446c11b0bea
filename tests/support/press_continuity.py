"""Counts where contacts or their force jump without a reason in the tool's motion."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from press_rig import PERIOD_S, Gains, Tick
from press_tools import PressTool

# How much a distance may change beyond twice the motion of the tool's points.
_UNFELT_M = 5e-6
# Cosine of the turn of a normal in a tick that counts as a jump.
_TURNED = 0.5
# A force may change by this many times what the motion explains, and by this more.
_EXPLAINED_TIMES = 3.0
_UNFELT_N = 0.1


@dataclass
class Jumps:
    """Ticks of a run on which something jumped.

    Attributes:
        ticks: Ticks with a contact on them and on the one before.
        distance: Ticks on which the least distance changed by more than the motion.
        turn: Ticks on which a pair of pieces that stayed in depth turned its normal by
            over 60°.
        force: Ticks on which the contacts' force changed by more than the motion
            explains.
        force_alone: Ticks with such a force on which neither of the above happened, nor
            a normal of the deepest contact turned: the clustering's doing.
        largest_N: The largest change of the force beyond what the motion explains.
    """

    ticks: int = 0
    distance: int = 0
    turn: int = 0
    force: int = 0
    force_alone: int = 0
    largest_N: float = 0.0


def count_jumps(ticks: list[Tick], tool: PressTool, gains: Gains) -> Jumps:
    """Counts the jumps of a run, from the first tick of `ticks` to the last."""
    radius_m = float(np.linalg.norm(tool.mesh.vertices, axis=1).max())
    jumps = Jumps()
    for last, now in pairwise(ticks):
        if not (len(last.contacts) and len(now.contacts)):
            continue
        jumps.ticks += 1
        # The step is implicit: the velocity after it is that of the motion.
        speed = _speed(now, radius_m)
        change_m = now.contacts.distance.min() - last.contacts.distance.min()
        jumped = abs(change_m) > 2 * speed * PERIOD_S + _UNFELT_M
        jumps.distance += jumped
        turned = _has_turned(last, now)
        jumps.turn += turned
        explained_N = gains.stiffness_N_per_m * speed * PERIOD_S
        explained_N += gains.damping_Ns_per_m * (speed + _speed(last, radius_m))
        change_N = float(np.linalg.norm((now.F_contact_W - last.F_contact_W)[3:]))
        excess_N = change_N - _EXPLAINED_TIMES * explained_N
        jumps.largest_N = max(jumps.largest_N, excess_N)
        if excess_N > _UNFELT_N:
            jumps.force += 1
            jumps.force_alone += not (jumped or turned or _deepest_turned(last, now))
    return jumps


def _speed(tick: Tick, radius_m: float) -> float:
    """A bound on the speed of the tool's points, m/s."""
    omega, v = tick.state[7:10], tick.state[10:]
    return float(np.linalg.norm(v) + radius_m * np.linalg.norm(omega))


def _has_turned(last: Tick, now: Tick) -> bool:
    """Tells whether a pair of pieces in depth on both ticks turned its normal."""
    a, b = last.contacts, now.contacts
    before = {
        (p, q): n
        for p, q, n, d in zip(
            a.piece_A, a.piece_B, a.nhat_BA_W, a.distance, strict=True
        )
        if d < 0
    }
    return any(
        d < 0 and (p, q) in before and before[p, q] @ n < _TURNED
        for p, q, n, d in zip(
            b.piece_A, b.piece_B, b.nhat_BA_W, b.distance, strict=True
        )
    )


def _deepest_turned(last: Tick, now: Tick) -> bool:
    a, b = last.contacts, now.contacts
    n = a.nhat_BA_W[np.argmin(a.distance)]
    return bool(n @ b.nhat_BA_W[np.argmin(b.distance)] < 0.95)
