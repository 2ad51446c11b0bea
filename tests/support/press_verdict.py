"""The verdict on a press, by the solid's triangles and by plain mechanics."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from press_continuity import Jumps, count_jumps
from press_rig import LARGEST_FORCE_N, PERIOD_S, Gains, Press, Tick, run_press
from press_tools import PressTool
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
    """The outcome of a press.

    Attributes:
        skipped: Reason why it tells nothing: no room for the tool, or no contact.
        lost_tick: First tick on which tool and solid overlapped and nothing pushed;
            -1 if none.
        through: Whether the tool's foremost point left the solid by the far side.
        inward_tick: First tick with a contact that pushed into the surface; -1.
        made_J: Largest energy that the contact gave beyond what it had been given.
        hooked_m: Distance of the tool from the handle at the end, if there was room for
            it there.
        depth_m: Largest depth of any contact.
        shallow: Deepest contact at rest over the depth of the innermost vertex.
        jumps: Jumps of contacts and of their force, until the retreat.
        finite: Whether there was neither NaN nor Inf.
        made_tick: Tick until which most energy was made.
    """

    skipped: str = ""
    lost_tick: int = -1
    through: bool = False
    inward_tick: int = -1
    made_J: float = 0.0
    hooked_m: float = 0.0
    depth_m: float = 0.0
    shallow: float = 1.0
    jumps: Jumps = field(default_factory=Jumps)
    finite: bool = True
    made_tick: int = -1


def judge(
    press: Press,
    tool: PressTool,
    solid: Surface,
    pieces: _core.ConvexPieces,
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
    lost_tick = find_lost_tick(states, forces, overlap)
    if lost_tick < 0 and not forces[:, 3:].any():
        return Verdict(skipped="no contact")
    verdict = Verdict(lost_tick=lost_tick)
    pressed = np.array([t.phase in ("in", "slide", "hold") for t in ticks])
    _judge_normals(verdict, ticks, solid, pieces)
    _judge_energy(verdict, ticks, states, forces, gains)
    verdict.jumps = count_jumps(
        [t for t, on in zip(ticks, pressed, strict=True) if on], tool, gains
    )
    _judge_depth(verdict, ticks, tool, solid)
    verdict.depth_m = max(-float(min(t.contacts.distance, default=0)) for t in ticks)
    probe = np.array([rotation_of(s) @ press.p_TP + s[4:7] for s in states[pressed]])
    # Springs as soft as some let the tool sink through a thin wall.
    spring_m = LARGEST_FORCE_N / gains.stiffness_N_per_m - gains.tolerance_m
    verdict.through = is_through(press, probe, solid, spring_m)
    # A handle that slid along a hollow ends in the wall: nothing to say there.
    end = _core.SceneTracker(tool.core, [pieces], gains.tolerance_m)
    if len(end.query(ticks[-1].q_WH)) == 0:
        gap_W = states[-1][4:7] - ticks[-1].q_WH[4:]
        verdict.hooked_m = float(np.linalg.norm(gap_W))
    return verdict


def find_lost_tick(states: np.ndarray, forces: np.ndarray, overlap: Overlap) -> int:
    """Returns the first tick on which tool and solid overlap and nothing pushes, or -1.

    Args:
        states: (n, 7) or (n, 13), pose of the tool first.
        forces: (n, 6), torque and force of contact on it, N·m and N.
        overlap: Overlap of tool and solid.
    """
    silent = np.flatnonzero(np.linalg.norm(forces[:, 3:], axis=1) < 1e-9)
    step = max(1, len(silent) // 100)
    return next((int(i) for i in silent[::step] if overlap(states[i, :7])), -1)


def is_through(
    press: Press, probe: np.ndarray, solid: Surface, spring_m: float
) -> bool:
    """Tells whether the tool's foremost point left the solid by the far side.

    Args:
        press: Press that was done.
        probe: (n, 3) that point while the tool was pressed, m.
        solid: The surface.
        spring_m: Depth to which the largest force presses the contact's spring, m.
    """
    sunk_m = (probe[-1] - press.p_W) @ -press.nhat_W
    return bool(sunk_m > spring_m + _BELOW_SPRING_M and solid.is_pierced(probe[::8]))


def _judge_normals(
    verdict: Verdict, ticks: list[Tick], solid: Surface, pieces: _core.ConvexPieces
) -> None:
    """Checks that a contact pushes out of the surface at the solid's feature.

    The witness itself is inside where the contact is deep, and the nearest surface
    there may be a thin wall's other side.
    """
    for i in range(0, len(ticks), _LOOK_EVERY):
        contacts = ticks[i].contacts
        for k in np.argsort(contacts.distance)[:3]:
            piece = pieces.pieces[contacts.piece_B[k]]
            p_W = _center_of(piece, *contacts.feature_B[k])
            if solid.facing(p_W, contacts.nhat_BA_W[k]) < -1e-3:
                verdict.inward_tick = i
                return


def _center_of(piece: _core.ConvexPolytope, kind: int, index: int) -> np.ndarray:
    """The middle (3,) of a vertex (kind 0), an edge (1) or a facet (2), m."""
    if kind == 0:
        return piece.vertices[index]
    corners = piece.edges[index] if kind == 1 else piece.facets[index]
    return piece.vertices[corners].mean(axis=0)


def _judge_energy(
    verdict: Verdict,
    ticks: list[Tick],
    states: np.ndarray,
    forces: np.ndarray,
    gains: Gains,
) -> None:
    """Checks that a spring gives back what it got: work plus store never rises."""
    power = np.einsum("ij,ij->i", forces[:-1], states[1:, 7:])
    work = np.concatenate([[0.0], np.cumsum(power) * PERIOD_S])
    held = [
        0.5
        * gains.stiffness_N_per_m
        * float(t.clusters.compression @ (gains.tolerance_m - t.clusters.distance))
        for t in ticks
    ]
    rise = (work + held) - np.minimum.accumulate(work + held)
    verdict.made_tick = int(np.argmax(rise))
    verdict.made_J = float(rise.max())


def _judge_depth(
    verdict: Verdict, ticks: list[Tick], tool: PressTool, solid: Surface
) -> None:
    last = [t for t in ticks if t.phase == "hold"][-1]
    R, p = rotation_of(last.state), last.state[4:7]
    inner = solid.inner_depth(tool.mesh.vertices @ R.T + p)
    if inner > _LEAST_DEPTH_M:
        verdict.shallow = -float(min(last.contacts.distance, default=0.0)) / inner
