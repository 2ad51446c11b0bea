"""What a press did, judged by the solid's triangles and by plain mechanics."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from press_rig import (
    LARGEST_FORCE_N,
    PERIOD_S,
    TOOL_MASS_KG,
    Gains,
    Press,
    PressTool,
    Tick,
    run_press,
)
from solid_surface import Overlap, Surface, rotation_of

from drake_haptics import _core

# A fall is more than this below where the contact's spring holds the tool.
_BELOW_SPRING_M = 1.5e-3
# Vertices less deep than this are not compared with the contact's depth.
_LEAST_DEPTH_M = 5e-5
# Ticks between two looks at the normals: truth is slower than the core.
_LOOK_EVERY = 10


@dataclass
class Verdict:
    """What a press showed.

    Attributes:
        skipped: Why it tells nothing: no room for the tool, or no contact.
        lost_tick: First tick on which tool and solid overlapped and nothing pushed;
            -1 if none.
        through: The tool's foremost point left the solid by the far side.
        inward_tick: First tick with a contact that pushed into the surface; -1.
        made_J: Most energy that the contact gave beyond what it had been given.
        hooked_m: How far from the handle the tool was at the end, if there was room
            for it there.
        depth_m: Largest depth of any contact.
        shallow: Deepest contact at rest over how deep the innermost vertex was.
        jump_N: Largest change of the contact's force in a tick beyond three times
            what the motion explains.
        rest_J: Largest kinetic energy in the last 0.1 s of the hold.
        drift_m: How far the tool wandered then.
        finite: No NaN, no Inf.
        ticks: Where the worst was: "made", "jump".
    """

    skipped: str = ""
    lost_tick: int = -1
    through: bool = False
    inward_tick: int = -1
    made_J: float = 0.0
    hooked_m: float = 0.0
    depth_m: float = 0.0
    shallow: float = 1.0
    jump_N: float = 0.0
    rest_J: float = 0.0
    drift_m: float = 0.0
    finite: bool = True
    ticks: dict[str, int] = field(default_factory=dict)


def judge(
    press: Press,
    tool: PressTool,
    solid: Surface,
    pieces: _core.Decomposition,
    gains: Gains,
    overlap: Overlap,
) -> Verdict:
    """Runs a press and judges it."""
    if overlap(press.q_WH(0.0, 0.0)):
        return Verdict(skipped="no room")
    ticks = list(run_press(press, tool, pieces, gains))
    states = np.array([t.state for t in ticks])
    forces = np.array([t.F_contact_W for t in ticks])
    if not (np.isfinite(states).all() and np.isfinite(forces).all()):
        return Verdict(finite=False)
    silent = np.flatnonzero(np.linalg.norm(forces[:, 3:], axis=1) < 1e-9)
    step = max(1, len(silent) // 100)
    lost_tick = next((int(i) for i in silent[::step] if overlap(states[i, :7])), -1)
    if lost_tick < 0 and len(silent) == len(ticks):
        return Verdict(skipped="no contact")
    verdict = Verdict(lost_tick=lost_tick)
    pressed = np.array([t.phase in ("in", "slide", "hold") for t in ticks])
    _judge_normals(verdict, ticks, solid)
    _judge_energy(verdict, ticks, states, forces, gains)
    _judge_jumps(verdict, states[pressed], forces[pressed, 3:], tool, gains)
    _judge_rest(verdict, ticks, tool, solid)
    verdict.depth_m = max(-float(min(t.contacts.distance, default=0)) for t in ticks)
    probe = np.array([rotation_of(s) @ press.p_TP + s[4:7] for s in states[pressed]])
    # Springs as soft as some let the tool sink through a thin wall.
    spring_m = LARGEST_FORCE_N / gains.stiffness_N_per_m - gains.tolerance_m
    sunk_m = (probe[-1] - press.p_W) @ -press.nhat_W
    verdict.through = bool(
        sunk_m > spring_m + _BELOW_SPRING_M and solid.is_pierced(probe[::8])
    )
    # A handle that slid along a hollow ends in the wall: nothing to say there.
    end = _core.ContactTracker(tool.core, [pieces], gains.tolerance_m)
    if len(end.query(ticks[-1].q_WH)) == 0:
        gap_W = states[-1][4:7] - ticks[-1].q_WH[4:]
        verdict.hooked_m = float(np.linalg.norm(gap_W))
    return verdict


def _judge_normals(verdict: Verdict, ticks: list[Tick], solid: Surface) -> None:
    """A contact pushes along its normal: it must leave the surface where it is."""
    for i in range(0, len(ticks), _LOOK_EVERY):
        contacts = ticks[i].contacts
        for k in np.argsort(contacts.distance)[:3]:
            if solid.facing(contacts.p_WCb[k], contacts.nhat_BA_W[k]) < -1e-3:
                verdict.inward_tick = i
                return


def _judge_energy(
    verdict: Verdict,
    ticks: list[Tick],
    states: np.ndarray,
    forces: np.ndarray,
    gains: Gains,
) -> None:
    """A spring gives back what it got: work plus what it holds never rises."""
    power = np.einsum("ij,ij->i", forces[:-1], states[1:, 7:])
    work = np.concatenate([[0.0], np.cumsum(power) * PERIOD_S])
    held = [
        0.5
        * gains.stiffness_N_per_m
        * np.sum(np.maximum(0, gains.tolerance_m - t.clusters.distance) ** 2)
        for t in ticks
    ]
    rise = (work + held) - np.minimum.accumulate(work + held)
    verdict.ticks["made"] = int(np.argmax(rise))
    verdict.made_J = float(rise.max())


def _judge_jumps(
    verdict: Verdict,
    states: np.ndarray,
    forces: np.ndarray,
    tool: PressTool,
    gains: Gains,
) -> None:
    radius = np.linalg.norm(tool.mesh.vertices, axis=1).max()
    speed = np.linalg.norm(states[:, 10:], axis=1)
    speed += radius * np.linalg.norm(states[:, 7:10], axis=1)
    # The step is implicit: the speed after it is that of the motion.
    explained = gains.stiffness_N_per_m * speed[1:] * PERIOD_S
    explained += gains.damping_Ns_per_m * (speed[1:] + speed[:-1])
    excess = np.linalg.norm(np.diff(forces, axis=0), axis=1) - 3 * explained
    verdict.ticks["jump"] = int(np.argmax(excess)) + 1
    verdict.jump_N = max(0.0, float(excess.max()))


def _judge_rest(
    verdict: Verdict, ticks: list[Tick], tool: PressTool, solid: Surface
) -> None:
    rest = [t for t in ticks if t.phase == "hold"][-100:]
    states = np.array([t.state for t in rest])
    speed = np.linalg.norm(states[:, 10:], axis=1)
    verdict.rest_J = float(0.5 * TOOL_MASS_KG * (speed**2).max())
    verdict.drift_m = float(np.ptp(states[:, 4:7], axis=0).max())
    R, p = rotation_of(states[-1]), states[-1, 4:7]
    inner = solid.inner_depth(tool.mesh.vertices @ R.T + p)
    if inner > _LEAST_DEPTH_M:
        verdict.shallow = -float(min(rest[-1].contacts.distance, default=0.0)) / inner
