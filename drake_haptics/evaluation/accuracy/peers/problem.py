"""Defines a library's problem and answers, and applies the scene's force law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from drake_haptics import _core
from drake_haptics.evaluation.accuracy.costs import make_native_part
from drake_haptics.evaluation.accuracy.native_part import NativePart
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.truth import Truth
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import Scene

# Number of passes that time each tick, whose middle half is averaged.
PASSES = 3


@dataclass(frozen=True, eq=False)
class PeerProblem:
    """A tool that moves as recorded among objects at rest, without effects.

    Attributes:
        tool: Tool in convex pieces, as the objects.
        part: Calls to this package's core for the same problem, with the force law.
        f_W: (n, 3) force of the reference, N, for fitting gains that the scene lacks.
    """

    scene: Scene
    motion: RecordedMotion
    tool: Decomposition
    objects: tuple[Decomposition, ...]
    part: NativePart
    f_W: np.ndarray

    @property
    def tolerance_m(self) -> float:
        """Distance below which pieces push each other apart, m."""
        return self.scene.contact.tolerance_m


@dataclass(frozen=True, eq=False)
class PeerAnswers:
    """The answers of a library at each of n ticks.

    Attributes:
        F_To_W: (n, 6) wrench [τ; f] on the tool at its origin in the world, N·m, N.
        distance: (n,) distance of the deepest contact, m; infinite without a contact.
        tolerance_m: Distance up to which the library found contacts, m.
        seconds: (n,) time inside the library, s.
        remark: Further parameters of the method. Defaults to none.
    """

    F_To_W: np.ndarray
    distance: np.ndarray
    tolerance_m: float
    seconds: np.ndarray
    remark: str = ""


# A method that answers the whole motion; raises an error if the library cannot.
Answer = Callable[[PeerProblem], PeerAnswers]


def make_peer_problem(
    haptic: HapticDiagram, motion: RecordedMotion, truth: Truth
) -> PeerProblem:
    """Returns the problem of a scene for all libraries."""
    part = make_native_part(haptic)
    return PeerProblem(
        scene=haptic.scene,
        motion=motion,
        tool=haptic.tool,
        objects=haptic.environment,
        # Braking searches farther, but is not contact.
        part=replace(part, search_m=part.tolerance_m),
        f_W=truth.F_Tcm_W[:, 3:],
    )


@dataclass(frozen=True, eq=False)
class FoundContacts:
    """The contacts at each of k ticks, n in all.

    Attributes:
        start: (k + 1,) first rows: tick i has the rows from start[i] to start[i + 1].
        rows: (n, 11) signed distance, m; unit normal out of the object into the tool;
            witness points on the tool and on the object, m; and the object's index.
        seconds: (k,) times of finding them, s.
    """

    start: np.ndarray
    rows: np.ndarray
    seconds: np.ndarray


def apply_law(problem: PeerProblem, found: FoundContacts) -> PeerAnswers:
    """Returns the wrenches of contacts by this package's clustering and penalty law.

    So only the query differs. A contact without a finite normal exerts no force.
    """
    part, motion = problem.part, problem.motion
    cluster, force = part.make_clustering(), part.make_force()
    F_To_W = np.zeros((len(motion), 6))
    distance = np.full(len(motion), np.inf)
    valid = np.isfinite(found.rows[:, 1:4]).all(axis=1)
    valid &= found.rows[:, 0] < part.tolerance_m
    for k in range(len(motion)):
        tick = slice(found.start[k], found.start[k + 1])
        rows = found.rows[tick][valid[tick]]
        if len(rows) == 0:
            continue
        rows = rows[np.argsort(rows[:, 10], kind="stable")]
        d, normal, p_WCa, p_WCb, owner = np.split(rows, [1, 4, 7, 10], axis=1)
        distance[k] = d.min()
        contacts = _core.contact_set(
            d.ravel(), normal, p_WCa, p_WCb, owner.ravel().astype(np.int32)
        )
        wrench = force(
            clusters=cluster(contacts), p_WTo=motion.X_WT[k, 4:], V_WT=motion.V_WT[k]
        )
        F_To_W[k] = wrench.F_To_W
    return PeerAnswers(F_To_W, distance, part.tolerance_m, found.seconds)
