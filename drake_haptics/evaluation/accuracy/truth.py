"""Finds the truth on a recorded motion, and the errors of other answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from drake_haptics._core import ConvexPair
from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.evaluation.accuracy.figures import Errors
from drake_haptics.evaluation.accuracy.recorded_motion import (
    RecordedMotion,
    replay_tool,
)
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import Scene

# A force below this share of the reference's largest has no meaningful direction.
_FIRM_SHARE = 0.1


def calc_exact_distance(haptic: HapticDiagram, X_WT: np.ndarray) -> np.ndarray:
    """Returns the signed distance of the deepest pair of convex pieces at each pose.

    Each pair is queried for the global depth, the proven least way out, at all poses at
    which its bounding spheres are near. The pairs are independent of each other and of
    a tracker. If tool and objects are one convex piece each, this is the exact
    penetration depth. Pieces of a larger mesh have faces that are not on the mesh: a
    contact never leaves through such a face, and so can be some micrometers deeper than
    the pair.

    Args:
        haptic: Diagram with the pieces of tool and objects, and the objects' poses.
        X_WT: (n, 7) poses of the tool, m.

    Returns:
        (n,) distances, m; infinite beyond the contact's tolerance.
    """
    tolerance_m = haptic.scene.contact.tolerance_m
    R_WT = _read_rotations(X_WT).as_matrix()
    best = np.full(len(X_WT), np.inf)
    objects = [
        (piece, item.pose.to_rigid_transform())
        for item, part in zip(haptic.scene.environment, haptic.environment, strict=True)
        for piece in part.pieces
    ]
    centers_W = np.array([X_WO @ piece.centroid for piece, X_WO in objects])
    reach_m = tolerance_m + np.array([piece.radius for piece, _ in objects])
    for tool_piece in haptic.tool.pieces:
        p_WC = X_WT[:, 4:] + R_WT @ tool_piece.centroid
        for i in _find_near(p_WC, centers_W, reach_m + tool_piece.radius):
            piece, X_WO = objects[i]
            apart_m = np.linalg.norm(p_WC - centers_W[i], axis=1)
            near = np.flatnonzero(apart_m < reach_m[i] + tool_piece.radius)
            pair = ConvexPair(tool_piece, piece, "global")
            found = pair.query_trajectory(X_WT[near], pose_to_vector(X_WO))
            best[near] = np.minimum(best[near], found.distance)
    return np.where(best < tolerance_m, best, np.inf)


def _find_near(p_WC: np.ndarray, centers_W: np.ndarray, reach: np.ndarray) -> list[int]:
    """Returns the indices of the spheres that a moving point may enter."""
    low, high = p_WC.min(axis=0), p_WC.max(axis=0)
    nearest = np.clip(centers_W, low, high)
    near = np.linalg.norm(centers_W - nearest, axis=1) < reach
    return np.flatnonzero(near).tolist()


@dataclass(frozen=True, eq=False)
class Truth:
    """The reference's wrench and the exact depth at n ticks of a motion.

    Attributes:
        F_Tcm_W: (n, 6) wrench [τ; f] at the tool's center of mass in the world, N·m and
            N.
        p_TTcm: (3,) the center of mass in the tool's frame, m.
        distance: (n,) exact distance of the deepest pair of pieces, m; infinite beyond
            the tolerance.
        tolerance_m: Contact tolerance of the reference, m.
    """

    F_Tcm_W: np.ndarray
    p_TTcm: np.ndarray
    distance: np.ndarray
    tolerance_m: float

    @property
    def num_contact_ticks(self) -> int:
        """Number of ticks with a contact."""
        return int(np.isfinite(self.distance).sum())

    def find_busiest(self, num_ticks: int) -> tuple[int, int]:
        """Returns first and end of the `num_ticks` (or fewer) with the most contact."""
        num_ticks = min(num_ticks, len(self.distance))
        touched = np.concatenate([[0], np.cumsum(np.isfinite(self.distance))])
        first = int((touched[num_ticks:] - touched[:-num_ticks]).argmax())
        return first, first + num_ticks


def find_truth(reference: Scene, motion: RecordedMotion) -> Truth:
    """Returns the reference's wrench along a motion, and the exact depth of the tool.

    The wrench is that of the finest setting with the scene's physics;
    `calc_exact_distance` finds the depth independently.
    """
    haptic = build_without_scene_warnings(reference)
    p_TTcm = haptic.loop.haptic_tool.dynamics.p_TTcm
    F_To_W = replay_tool(reference, motion).F_To_W
    return Truth(
        F_Tcm_W=shift_wrench(F_To_W, motion.X_WT, p_TTcm),
        p_TTcm=p_TTcm,
        distance=calc_exact_distance(haptic, motion.X_WT),
        tolerance_m=reference.contact.tolerance_m,
    )


def shift_wrench(F_To_W: np.ndarray, X_WT: np.ndarray, p_TP: np.ndarray) -> np.ndarray:
    """Returns wrenches (n, 6) on the tool at another point P.

    The force is the same, and τ_P = τ - p × f.

    Args:
        F_To_W: (n, 6) wrenches [τ; f] at the tool's origin in the world.
        X_WT: (n, 7) poses of the tool.
        p_TP: (3,) the point in the tool's frame, m.
    """
    torque, force = np.split(F_To_W, 2, axis=1)
    p_TP_W = _read_rotations(X_WT).apply(p_TP)
    return np.hstack([torque - np.cross(p_TP_W, force), force])


def _read_rotations(X_WT: np.ndarray) -> Rotation:
    return Rotation.from_quat(np.roll(X_WT[:, :4], -1, axis=1))


def measure_open_loop(scene: Scene, motion: RecordedMotion, truth: Truth) -> Errors:
    """Replays a motion in a scene and compares its answers with the truth.

    The errors lack those of the closed loop: energy is NaN, stiffness None.
    """
    replay = replay_tool(scene, motion)
    F_Tcm_W = shift_wrench(replay.F_To_W, motion.X_WT, truth.p_TTcm)
    return compare(F_Tcm_W, replay.distance, scene.contact.tolerance_m, truth)


def compare(
    F_Tcm_W: np.ndarray, distance: np.ndarray, tolerance_m: float, truth: Truth
) -> Errors:
    """Compares wrenches and distances from any source with the truth at n ticks.

    Depths are compared up to the lesser of the two tolerances.

    Args:
        F_Tcm_W: (n, 6) wrench [τ; f] at the truth's center of mass, N·m and N.
        distance: (n,) distance of the deepest contact, m; infinite without a contact.
        tolerance_m: Distance up to which contacts were found, m.
        truth: Truth at the same ticks.
    """
    error = np.linalg.norm((F_Tcm_W - truth.F_Tcm_W).reshape(-1, 2, 3), axis=2)
    rms, largest = np.sqrt((error**2).mean(axis=0)), error.max(axis=0)
    cap_m = min(tolerance_m, truth.tolerance_m)
    depth = np.minimum(distance, cap_m) - np.minimum(truth.distance, cap_m)
    firm_N = _FIRM_SHARE * float(np.linalg.norm(truth.F_Tcm_W[:, 3:], axis=1).max())
    turn = _calc_turns(F_Tcm_W[:, 3:], firm_N)
    expected = _calc_turns(truth.F_Tcm_W[:, 3:], firm_N)
    return Errors(
        force_rms_N=float(rms[1]),
        force_max_N=float(largest[1]),
        torque_rms_Nm=float(rms[0]),
        torque_max_Nm=float(largest[0]),
        depth_max_m=float(np.abs(depth).max()),
        normal_jump_deg=float(np.rad2deg((turn - expected).max(initial=0.0))),
    )


def _calc_turns(force: np.ndarray, firm_N: float) -> np.ndarray:
    """Returns (n - 1,) angles between forces at successive ticks, rad.

    An angle is zero unless both forces are larger than `firm_N`.
    """
    before, after = force[:-1], force[1:]
    # Sine and cosine together are accurate for small and large turns.
    sine = np.linalg.norm(np.cross(before, after), axis=1)
    turn = np.arctan2(sine, np.einsum("ni,ni->n", before, after))
    size = np.linalg.norm(force, axis=1)
    firm = (np.minimum(size[:-1], size[1:]) > firm_N) & (firm_N > 0.0)
    return np.where(firm, turn, 0.0)
