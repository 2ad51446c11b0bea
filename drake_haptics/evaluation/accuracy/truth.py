"""What settings are compared with on a recorded motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics.analysis.held_scene import build_quietly
from drake_haptics.evaluation.accuracy.exact_distance import calc_exact_distance
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.tool_replay import replay_tool
from drake_haptics.scene.schema import Scene


@dataclass(frozen=True, eq=False)
class Truth:
    """The reference's wrench and the exact depth at n ticks of a motion.

    Attributes:
        F_Tcm_W: (n, 6) wrench [τ; f] at the tool's center of mass in the world, N·m
            and N.
        p_TTcm: (3,) the center of mass in the tool's frame, m.
        distance: (n,) exact distance of the deepest pair of pieces, m; infinite beyond
            the tolerance.
        tolerance_m: Of the reference, m.
    """

    F_Tcm_W: np.ndarray
    p_TTcm: np.ndarray
    distance: np.ndarray
    tolerance_m: float

    @property
    def num_contact_ticks(self) -> int:
        """At how many ticks there is a contact."""
        return int(np.isfinite(self.distance).sum())

    def find_busiest(self, num_ticks: int) -> tuple[int, int]:
        """Returns first and end of the stretch of ticks with the most contact.

        Args:
            num_ticks: Its length; all where there are no more.
        """
        num_ticks = min(num_ticks, len(self.distance))
        touched = np.concatenate([[0], np.cumsum(np.isfinite(self.distance))])
        first = int((touched[num_ticks:] - touched[:-num_ticks]).argmax())
        return first, first + num_ticks


def find_truth(reference: Scene, motion: RecordedMotion) -> Truth:
    """Returns what the reference answers to a motion, and how deep the tool is.

    The wrench is the finest that the scene's own physics gives; the depth is found
    without it, see `exact_distance`.

    Args:
        reference: The scene with its finest exact setting.
        motion: Of its tool.
    """
    haptic = build_quietly(reference)
    p_TTcm = haptic.loop.haptic_tool.dynamics.p_TTcm
    F_Tool_W = replay_tool(reference, motion).F_Tool_W
    return Truth(
        F_Tcm_W=shift_wrench(F_Tool_W, motion.X_WTool, p_TTcm),
        p_TTcm=p_TTcm,
        distance=calc_exact_distance(haptic, motion.X_WTool),
        tolerance_m=reference.contact.tolerance_m,
    )


def shift_wrench(
    F_Tool_W: np.ndarray, X_WTool: np.ndarray, p_TP: np.ndarray
) -> np.ndarray:
    """Returns wrenches on the tool at another of its points.

    Args:
        F_Tool_W: (n, 6) wrenches [τ; f] at the tool's origin in the world.
        X_WTool: (n, 7) poses of the tool.
        p_TP: (3,) the point in the tool's frame, m.

    Returns:
        (n, 6) [τ; f] at P: the force is the same, τ_P = τ - p × f.
    """
    w, xyz = X_WTool[:, :1], X_WTool[:, 1:4]
    # A unit quaternion turns p to p + 2 w (q × p) + 2 q × (q × p).
    turned = np.cross(xyz, p_TP)
    p_TP_W = p_TP + 2.0 * (w * turned + np.cross(xyz, turned))
    force = F_Tool_W[:, 3:]
    return np.hstack([F_Tool_W[:, :3] - np.cross(p_TP_W, force), force])
