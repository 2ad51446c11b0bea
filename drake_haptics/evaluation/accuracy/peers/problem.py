"""What a library is asked, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from drake_haptics.evaluation.accuracy.native_cost import make_native_part
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.truth import Truth
from drake_haptics.evaluation.measuring.native_part import NativePart
from drake_haptics.geometry.decomposition.decompose import Decomposition
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import Scene

# As often each tick is timed; what it took is the middle of them.
PASSES = 3


@dataclass(frozen=True, eq=False)
class PeerProblem:
    """A tool that moves as recorded among objects at rest; without effects.

    Attributes:
        scene: Its gains.
        motion: Of the tool.
        tool: In convex pieces.
        objects: In convex pieces.
        part: What this package's core is asked for the same; with the law of force.
        f_W: (n, 3) the reference's force, for gains that the scene does not have, N.
    """

    scene: Scene
    motion: RecordedMotion
    tool: Decomposition
    objects: tuple[Decomposition, ...]
    part: NativePart
    f_W: np.ndarray

    @property
    def tolerance_m(self) -> float:
        """Pieces nearer than this push each other apart, m."""
        return self.scene.contact.tolerance_m


@dataclass(frozen=True, eq=False)
class PeerAnswers:
    """What a library answered at each of n ticks.

    Attributes:
        F_Tool_W: (n, 6) wrench [τ; f] on the tool at its origin in the world, N·m, N.
        distance: (n,) of the deepest contact, m; infinite where there is none.
        tolerance_m: How far it looked for contacts, m.
        seconds: (n,) time inside the library, s.
        remark: What the method was given besides, empty otherwise.
    """

    F_Tool_W: np.ndarray
    distance: np.ndarray
    tolerance_m: float
    seconds: np.ndarray
    remark: str = ""


class Answer(Protocol):
    """A way to a contact wrench."""

    def __call__(self, problem: PeerProblem) -> PeerAnswers:
        """Answers the whole motion; raises where the library cannot."""
        ...


def make_peer_problem(
    haptic: HapticDiagram, motion: RecordedMotion, truth: Truth
) -> PeerProblem:
    """Returns what all libraries are asked about a scene.

    Args:
        haptic: The scene, built.
        motion: Of its tool.
        truth: On that motion.
    """
    part = make_native_part(haptic)
    return PeerProblem(
        scene=haptic.scene,
        motion=motion,
        tool=haptic.tool,
        objects=haptic.environment,
        # Braking looks further; it is no contact.
        part=replace(part, search_m=part.tolerance_m),
        f_W=truth.F_Tcm_W[:, 3:],
    )
